#include "reconstruct/sample/layer_hashes.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 64;
constexpr std::string_view kBetween = "  ";  // the second space says: not as text

bool is_hexadecimal(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char letter) {
    return (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'f');
  });
}

/// The lines that have their end.
std::vector<std::string> whole_lines(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    throw SampleError(path.string() + ": cannot be opened");
  }
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line) && !in.eof();) {
    lines.push_back(line);
  }
  return lines;
}

std::optional<LayerHash> parse_line(std::string_view line) {
  const std::string_view hash = line.substr(0, kDigits);
  if (line.size() <= kDigits + kBetween.size() || !is_hexadecimal(hash) ||
      line.substr(kDigits, kBetween.size()) != kBetween) {
    return std::nullopt;
  }
  return LayerHash{std::string(line.substr(kDigits + kBetween.size())), std::string(hash)};
}

}  // namespace

std::string layer_hash_lines(const std::vector<LayerHash>& hashes) {
  std::string lines;
  for (const LayerHash& each : hashes) {
    lines += each.sha256;
    lines += kBetween;
    lines += each.file;
    lines += '\n';
  }
  return lines;
}

std::vector<LayerHash> read_layer_hashes(const fs::path& path) {
  std::vector<LayerHash> hashes;
  for (const std::string& line : whole_lines(path)) {
    auto hash = parse_line(line);
    if (!hash) {
      throw SampleError(path.string() + ": line " + std::to_string(hashes.size() + 1) +
                        " is not a SHA-256 and a file name");
    }
    hashes.push_back(*std::move(hash));
  }
  return hashes;
}

std::vector<LayerHash> readable_layer_hashes(const fs::path& path) {
  std::vector<LayerHash> hashes;
  for (const std::string& line : whole_lines(path)) {
    if (auto hash = parse_line(line)) {
      hashes.push_back(*std::move(hash));
    }
  }
  return hashes;
}

}  // namespace biotomy::reconstruct
