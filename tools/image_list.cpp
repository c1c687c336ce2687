#include "tools/image_list.hpp"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/image_file.hpp"

namespace biotomy::tools {
namespace {

namespace fs = std::filesystem;
using reconstruct::SampleError;

bool is_digit(char letter) {
  return std::isdigit(static_cast<unsigned char>(letter)) != 0;
}

/// The digits from `begin` on, without leading zeros. `begin` moves behind them.
std::string digits_at(const std::string& name, std::size_t& begin) {
  std::size_t end = begin;
  while (end < name.size() && is_digit(name[end])) ++end;
  while (begin + 1 < end && name[begin] == '0') ++begin;
  std::string digits = name.substr(begin, end - begin);
  begin = end;
  return digits;
}

std::vector<fs::path> images_in(const fs::path& folder) {
  std::vector<fs::path> images;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const fs::path& path = entry.path();
    if (reconstruct::is_image_name(path) && path.filename().string().front() != '.' &&
        entry.is_regular_file(error)) {
      images.push_back(path);
    }
  }
  if (error) throw SampleError(folder.string() + ": cannot be listed: " + error.message());
  if (images.empty()) {
    throw SampleError(folder.string() + ": there are no images (PNG, TIFF, JPEG) in it");
  }
  std::sort(images.begin(), images.end(), [](const fs::path& one, const fs::path& another) {
    return comes_before(one.filename().string(), another.filename().string());
  });
  return images;
}

}  // namespace

bool comes_before(const std::string& one, const std::string& another) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < one.size() && j < another.size()) {
    if (is_digit(one[i]) && is_digit(another[j])) {
      const std::string a = digits_at(one, i);
      const std::string b = digits_at(another, j);
      if (a.size() != b.size()) return a.size() < b.size();
      if (a != b) return a < b;
    } else if (one[i] != another[j]) {
      return one[i] < another[j];
    } else {
      ++i;
      ++j;
    }
  }
  if (one.size() - i != another.size() - j) return one.size() - i < another.size() - j;
  return one < another;
}

std::vector<fs::path> list_images(const std::vector<std::string>& inputs) {
  std::vector<fs::path> images;
  for (const std::string& input : inputs) {
    std::error_code error;
    if (fs::is_directory(input, error)) {
      const std::vector<fs::path> found = images_in(input);
      images.insert(images.end(), found.begin(), found.end());
    } else if (fs::exists(input, error)) {
      images.emplace_back(input);
    } else {
      throw SampleError(input + ": there is no such file or folder: check its name");
    }
  }
  return images;
}

}  // namespace biotomy::tools
