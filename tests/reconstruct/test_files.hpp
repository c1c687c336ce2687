#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace biotomy::reconstruct {

inline std::vector<std::byte> read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto* data = reinterpret_cast<const std::byte*>(text.data());
  return {data, data + text.size()};
}

inline void write_file(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// Cuts a file down to a share of its length.
inline void truncate_file(const std::filesystem::path& path, double share) {
  const auto size = static_cast<double>(std::filesystem::file_size(path));
  std::filesystem::resize_file(path, static_cast<std::uintmax_t>(size * share));
}

inline void flip_byte(const std::filesystem::path& path, std::size_t position) {
  auto bytes = read_file(path);
  bytes.at(position) ^= std::byte{0xFF};
  write_file(path, bytes);
}

/// Puts other words in the place of some, which must be there once.
inline void replace_text(const std::filesystem::path& path, const std::string& from,
                         const std::string& to) {
  const auto bytes = read_file(path);
  std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t place = text.find(from);
  if (place == std::string::npos || text.find(from, place + 1) != std::string::npos) {
    throw std::invalid_argument(path.string() + " does not say '" + from + "' once");
  }
  write_text(path, text.replace(place, from.size(), to));
}

inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

/// Every file below a folder, by its relative path.
inline std::map<std::string, std::vector<std::byte>> contents_of(
    const std::filesystem::path& folder) {
  std::map<std::string, std::vector<std::byte>> contents;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      contents[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
    }
  }
  return contents;
}

/// The names of the files that two contents do not have in common, or not alike.
inline std::vector<std::string> differing_files(
    const std::map<std::string, std::vector<std::byte>>& a,
    const std::map<std::string, std::vector<std::byte>>& b) {
  std::vector<std::string> names;
  for (const auto& [name, bytes] : a) {
    if (const auto found = b.find(name); found == b.end() || found->second != bytes) {
      names.push_back(name);
    }
  }
  for (const auto& [name, bytes] : b) {
    if (a.find(name) == a.end()) {
      names.push_back(name);
    }
  }
  return names;
}

/// What an action throws of a kind, or nothing.
template <typename Error, typename Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

}  // namespace biotomy::reconstruct
