#include "reconstruct/import/image_sequence.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostDigits = 18;  // fits into 64 bits

constexpr const char* kNoNumber =
    ": has no number in its name, which tells the layer, as in layer_0001.tif; split a file of "
    "several pages into one file a layer";

/// A file name cut at its number.
struct NumberedName {
  fs::path path;
  std::string before;
  std::string after;  ///< without the extension
  std::int64_t number = 0;
};

bool is_digit(char letter) {
  return std::isdigit(static_cast<unsigned char>(letter)) != 0;
}

/// None when the name has no number.
std::optional<NumberedName> cut(const fs::path& path) {
  const std::string stem = path.stem().string();
  const auto end = std::find_if(stem.rbegin(), stem.rend(), is_digit).base();
  const auto begin =
      std::find_if_not(std::make_reverse_iterator(end), stem.rend(), is_digit).base();
  const std::string digits(begin, end);
  if (digits.empty()) {
    return std::nullopt;
  }
  if (digits.size() > kMostDigits) {
    throw SampleError(path.string() + ": the number in its name is too long");
  }
  return NumberedName{path, {stem.begin(), begin}, {end, stem.end()}, std::stoll(digits)};
}

std::vector<NumberedName> names_in_folder(const fs::path& folder) {
  std::vector<NumberedName> names;
  std::vector<fs::path> without_number;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const fs::path& path = entry.path();
    std::error_code status;
    if (is_image_name(path) && path.filename().string().front() != '.' &&
        !entry.is_directory(status)) {
      auto name = cut(path);
      if (name && !entry.is_regular_file(status)) {
        throw SampleError(path.string() +
                          ": is no file, or a link that leads nowhere: take it away");
      }
      if (name) {
        names.push_back(*std::move(name));
      } else {
        without_number.push_back(path);
      }
    }
  }
  if (error) {
    throw SampleError(folder.string() + ": cannot be listed: " + error.message());
  }
  if (names.empty() && !without_number.empty()) {
    throw SampleError(std::min_element(without_number.begin(), without_number.end())->string() +
                      kNoNumber);
  }
  if (names.empty()) {
    throw SampleError(folder.string() +
                      ": there are no images (PNG, TIFF, JPEG): give the folder that holds them");
  }
  return names;
}

std::vector<NumberedName> names_of_files(const std::vector<fs::path>& files) {
  std::vector<NumberedName> names;
  for (const fs::path& path : files) {
    std::error_code error;
    if (!fs::exists(path, error)) {
      throw SampleError(path.string() + (error ? ": cannot be reached: " + error.message()
                                               : ": there is no such file: check its name"));
    }
    if (!fs::is_regular_file(path, error)) {
      throw SampleError(path.string() + ": is not a file; give one folder, or files only");
    }
    if (!is_image_name(path)) {
      throw SampleError(path.string() + ": is not a PNG, TIFF or JPEG by its name");
    }
    auto name = cut(path);
    if (!name) {
      throw SampleError(path.string() + kNoNumber);
    }
    names.push_back(*std::move(name));
  }
  if (names.empty()) {
    throw SampleError("no images were given");
  }
  return names;
}

void check_alike(const std::vector<NumberedName>& names) {
  const NumberedName& first = names.front();
  for (const NumberedName& name : names) {
    if (name.before != first.before || name.after != first.after) {
      throw SampleError(name.path.string() + ": is not named like " +
                        first.path.filename().string() +
                        " apart from the number; are these images of one stack?");
    }
  }
}

void check_numbers(const std::vector<NumberedName>& names) {
  for (std::size_t i = 1; i < names.size(); ++i) {
    const NumberedName& before = names[i - 1];
    const NumberedName& name = names[i];
    if (name.number == before.number) {
      throw SampleError(name.path.string() + ": has the same number as " +
                        before.path.filename().string());
    }
    if (name.number != before.number + 1) {
      throw SampleError(name.path.parent_path().string() + ": number " +
                        std::to_string(before.number + 1) + " is missing between " +
                        before.path.filename().string() + " and " + name.path.filename().string());
    }
  }
}

std::string describe(cv::Size size, int type) {
  return std::to_string(size.width) + " × " + std::to_string(size.height) + " pixels of " +
         (type == CV_8UC3 ? "8" : "16") + " bits";
}

}  // namespace

ImageSequence::ImageSequence(std::vector<fs::path> files) : files_(std::move(files)) {
  const cv::Mat first = read_image_file(files_.front());
  size_ = first.size();
  type_ = first.type();
}

ImageSequence ImageSequence::find(const std::vector<fs::path>& inputs) {
  std::error_code error;
  std::vector<NumberedName> names = inputs.size() == 1 && fs::is_directory(inputs.front(), error)
                                        ? names_in_folder(inputs.front())
                                        : names_of_files(inputs);
  // By path too, so that messages do not depend on the order in which a folder is listed.
  std::sort(names.begin(), names.end(), [](const NumberedName& a, const NumberedName& b) {
    return std::pair(a.number, a.path) < std::pair(b.number, b.path);
  });
  check_alike(names);
  check_numbers(names);
  std::vector<fs::path> files;
  files.reserve(names.size());
  for (NumberedName& name : names) {
    files.push_back(std::move(name.path));
  }
  return ImageSequence(std::move(files));
}

cv::Mat ImageSequence::read(std::int64_t layer) const {
  const fs::path& path = files_[static_cast<std::size_t>(layer - 1)];
  cv::Mat image = read_image_file(path);
  if (image.size() != size_ || image.type() != type_) {
    throw SampleError(path.string() + ": is " + describe(image.size(), image.type()) +
                      ", expected " + describe(size_, type_) + " like " +
                      files_.front().filename().string());
  }
  return image;
}

}  // namespace biotomy::reconstruct
