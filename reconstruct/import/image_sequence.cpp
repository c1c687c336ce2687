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

constexpr std::size_t kMostDigits = 18;     // fits into 64 bits
constexpr std::int64_t kLongestGap = 1000;  // layers: beyond, a stray file is more likely

constexpr const char* kNoNumber =
    ": has no number in its name, which tells the layer, as in layer_0001.tif; a TIFF whose pages "
    "are "
    "the layers is given by its own name, alone";

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

/// How many layers are missing between two that follow each other in the order of their numbers.
std::int64_t gap_between(const NumberedName& before, const NumberedName& name,
                         const ImageNumbering& numbering) {
  const std::int64_t distance = name.number - before.number;
  const std::string here = name.path.string();
  const std::string earlier = before.path.filename().string();
  if (distance == 0) {
    throw SampleError(here + ": has the same number as " + earlier);
  }
  if (distance % numbering.step != 0) {
    throw SampleError(here + ": has a number " + std::to_string(distance) + " above that of " +
                      earlier + ", which is no multiple of the step, " +
                      std::to_string(numbering.step));
  }
  const std::int64_t missing = distance / numbering.step - 1;
  if (missing > 0 && !numbering.repeats_over_gaps) {
    throw SampleError(name.path.parent_path().string() + ": number " +
                      std::to_string(before.number + numbering.step) + " is missing between " +
                      earlier + " and " + name.path.filename().string() +
                      ": --gaps repeat takes the image before a gap for it too, --number-step N is "
                      "for numbers in steps of N");
  }
  if (missing > kLongestGap) {
    throw SampleError(here + ": there are " + std::to_string(missing) +
                      " layers missing before it; is it of this stack?");
  }
  return missing;
}

void check_unnumbered(const fs::path& path, const ImageNumbering& numbering) {
  if (numbering.step != 1 || numbering.repeats_over_gaps) {
    throw InvalidRequest(path.string() +
                         ": its pages are the layers and have no numbers: leave out --number-step "
                         "and --gaps");
  }
}

std::string describe(cv::Size size, int type) {
  return std::to_string(size.width) + " × " + std::to_string(size.height) + " pixels of " +
         (type == CV_8UC3 ? "8" : "16") + " bits";
}

}  // namespace

ImageSequence::ImageSequence(std::vector<fs::path> files, std::vector<std::int64_t> repeated)
    : files_(std::move(files)), repeated_(std::move(repeated)) {
  take_size();
}

ImageSequence::ImageSequence(const fs::path& file, std::vector<TiffPage> pages)
    : files_(pages.size(), file), pages_(std::move(pages)) {
  take_size();
}

void ImageSequence::take_size() {
  const cv::Mat first = read_any(1);
  size_ = first.size();
  type_ = first.type();
}

ImageSequence ImageSequence::find(const std::vector<fs::path>& inputs,
                                  const ImageNumbering& numbering) {
  std::error_code error;
  if (inputs.size() == 1 && is_tiff_name(inputs.front()) &&
      fs::is_regular_file(inputs.front(), error)) {
    std::vector<TiffPage> pages = pages_of_stack(inputs.front());
    if (pages.size() > 1) {
      check_unnumbered(inputs.front(), numbering);
      return {inputs.front(), std::move(pages)};
    }
  }
  std::vector<NumberedName> names = inputs.size() == 1 && fs::is_directory(inputs.front(), error)
                                        ? names_in_folder(inputs.front())
                                        : names_of_files(inputs);
  // By path too, so that messages do not depend on the order in which a folder is listed.
  std::sort(names.begin(), names.end(), [](const NumberedName& a, const NumberedName& b) {
    return std::pair(a.number, a.path) < std::pair(b.number, b.path);
  });
  check_alike(names);
  std::vector<fs::path> files{names.front().path};
  std::vector<std::int64_t> repeated;
  for (std::size_t i = 1; i < names.size(); ++i) {
    for (std::int64_t gap = gap_between(names[i - 1], names[i], numbering); gap > 0; --gap) {
      files.push_back(names[i - 1].path);
      repeated.push_back(static_cast<std::int64_t>(files.size()));
    }
    files.push_back(names[i].path);
  }
  if (repeated.size() > names.size()) {
    throw SampleError(names.front().path.parent_path().string() + ": of " +
                      std::to_string(files.size()) + " layers " + std::to_string(repeated.size()) +
                      " are missing; do the numbers go in steps (--number-step)?");
  }
  return {std::move(files), std::move(repeated)};
}

cv::Mat ImageSequence::read_any(std::int64_t layer) const {
  const auto place = static_cast<std::size_t>(layer - 1);
  if (pages_.empty()) {
    return read_image_file(files_[place]);
  }
  try {
    return read_image_page(files_[place], pages_[place]);
  } catch (const SampleError& error) {
    throw SampleError(std::string(error.what()) + ", layer " + std::to_string(layer) + " in it");
  }
}

cv::Mat ImageSequence::read(std::int64_t layer) const {
  cv::Mat image = read_any(layer);
  if (image.size() != size_ || image.type() != type_) {
    const std::string difference = "is " + describe(image.size(), image.type()) + ", expected " +
                                   describe(size_, type_) + " like ";
    const std::string path = files_[static_cast<std::size_t>(layer - 1)].string();
    throw SampleError(pages_.empty() ? path + ": " + difference + files_.front().filename().string()
                                     : path + ": layer " + std::to_string(layer) + " in it " +
                                           difference + "its first");
  }
  return image;
}

}  // namespace biotomy::reconstruct
