#include "reconstruct/sample/image_file.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/sample/image_integrity.hpp"
#include "reconstruct/sample/tiff_image.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

enum class Format { png, jpeg, tiff, unknown };

Format format_of_name(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char letter) { return std::tolower(letter); });
  if (extension == ".png") {
    return Format::png;
  }
  if (extension == ".jpg" || extension == ".jpeg") {
    return Format::jpeg;
  }
  return extension == ".tif" || extension == ".tiff" ? Format::tiff : Format::unknown;
}

std::vector<std::byte> read_whole(const fs::path& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) {
    throw SampleError(path.string() + ": cannot be opened");
  }
  const std::streamoff size = in.tellg();
  std::vector<std::byte> bytes(size > 0 ? static_cast<std::size_t>(size) : 0);
  in.seekg(0);
  if (bytes.empty() || !in.read(reinterpret_cast<char*>(bytes.data()), size)) {
    throw SampleError(path.string() + ": is empty or cannot be read");
  }
  return bytes;
}

cv::Mat to_rgb(const cv::Mat& image, const fs::path& path) {
  if (image.depth() != CV_8U && image.depth() != CV_16U) {
    throw SampleError(path.string() + ": is neither of 8 nor of 16 bits a colour");
  }
  cv::Mat rgb;
  switch (image.channels()) {
    case 1:
      cv::cvtColor(image, rgb, cv::COLOR_GRAY2RGB);
      return rgb;
    case 3:
      cv::cvtColor(image, rgb, cv::COLOR_BGR2RGB);
      return rgb;
    case 4:
      cv::cvtColor(image, rgb, cv::COLOR_BGRA2RGB);
      return rgb;
    default:
      throw SampleError(path.string() + ": has " + std::to_string(image.channels()) +
                        " channels; expected grey, RGB or RGBA");
  }
}

}  // namespace

bool is_image_name(const fs::path& path) {
  return format_of_name(path) != Format::unknown;
}

cv::Mat read_image_file(const fs::path& path) {
  const Format format = format_of_name(path);
  if (format == Format::tiff) {
    return read_tiff_image(path);
  }
  if (format == Format::unknown) {
    throw SampleError(path.string() + ": is not a PNG, TIFF or JPEG by its name");
  }
  const std::vector<std::byte> bytes = read_whole(path);
  // OpenCV fills what a truncated file lacks and says nothing that a program could hear.
  const auto damage = format == Format::png ? png_damage(bytes) : jpeg_damage(bytes);
  if (damage) {
    throw SampleError(path.string() + ": is damaged: " + *damage);
  }
  cv::Mat image;
  try {
    image = cv::imdecode(
        cv::Mat(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<std::byte*>(bytes.data())),
        cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    image.release();  // too large, for instance; the message below serves
  }
  if (image.empty()) {
    throw SampleError(path.string() + ": cannot be decoded");
  }
  return to_rgb(image, path);
}

}  // namespace biotomy::reconstruct
