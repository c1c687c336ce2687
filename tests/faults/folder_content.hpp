#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

namespace biotomy::tests {

/// The bytes of every file below a folder, hidden ones too, by its path in the folder. Of a
/// `sample.toml` the line with the time of its creation is left out.
using FolderContent = std::map<std::string, std::string>;

inline std::string without_time(std::string description) {
  const std::size_t begin = description.find("created = ");
  return begin == std::string::npos
             ? description
             : description.erase(begin, description.find('\n', begin) - begin);
}

inline FolderContent content_of_folder(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  FolderContent content;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (entry.path().filename() == "sample.toml") bytes = without_time(std::move(bytes));
    content[fs::relative(entry.path(), folder)] = std::move(bytes);
  }
  return content;
}

}  // namespace biotomy::tests
