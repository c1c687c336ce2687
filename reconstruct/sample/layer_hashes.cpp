#include "reconstruct/sample/layer_hashes.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string_view>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr std::size_t kDigits = 64;
constexpr std::string_view kBetween = "  ";  // the second space says: not as text

bool is_hexadecimal(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char letter) {
    return (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'f');
  });
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

std::vector<LayerHash> read_layer_hashes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    throw SampleError(path.string() + ": cannot be opened");
  }
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  std::vector<LayerHash> hashes;
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    const std::string_view hash = line.substr(0, std::min(kDigits, line.size()));
    if (line.size() <= kDigits + kBetween.size() || !is_hexadecimal(hash) ||
        line.substr(kDigits, kBetween.size()) != kBetween) {
      throw SampleError(path.string() + ": line " + std::to_string(hashes.size() + 1) +
                        " is not a SHA-256 and a file name");
    }
    hashes.push_back({std::string(line.substr(kDigits + kBetween.size())), std::string(hash)});
    begin = end + 1;
  }
  return hashes;
}

}  // namespace biotomy::reconstruct
