#include "reconstruct/section/section_image.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <zlib.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/durable_file.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr double kMicrometresPerMetre = 1e6;
constexpr double kMicrometresPerCentimetre = 1e4;
constexpr int kCentimetres = 3;     // TIFF's RESUNIT_CENTIMETER
constexpr int kDeflate = 8;         // TIFF's COMPRESSION_ADOBE_DEFLATE
constexpr std::uint8_t kMetre = 1;  // of PNG's pHYs

// PNG: the signature of 8 bytes, then the chunk IHDR of 25; pHYs may stand right after it.
constexpr std::ptrdiff_t kAfterHeader = 8 + 25;

void append_big_endian(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(value >> static_cast<unsigned>(shift)));
  }
}

// OpenCV writes no pHYs (PNG specification, 11.3.5.3).
void insert_pixel_size(std::vector<std::uint8_t>& png, double pixel) {
  const double per_metre = std::round(kMicrometresPerMetre / pixel);
  if (per_metre < 1.0 || per_metre > std::numeric_limits<std::int32_t>::max()) {
    return;  // what the format can't say is left unsaid
  }
  std::vector<std::uint8_t> chunk;
  append_big_endian(chunk, 9);
  for (const char letter : {'p', 'H', 'Y', 's'}) {
    chunk.push_back(static_cast<std::uint8_t>(letter));
  }
  append_big_endian(chunk, static_cast<std::uint32_t>(per_metre));
  append_big_endian(chunk, static_cast<std::uint32_t>(per_metre));
  chunk.push_back(kMetre);
  const auto crc = crc32(0, chunk.data() + 4, static_cast<uInt>(chunk.size() - 4));
  append_big_endian(chunk, static_cast<std::uint32_t>(crc));
  png.insert(png.begin() + kAfterHeader, chunk.begin(), chunk.end());
}

std::vector<std::uint8_t> encode(const cv::Mat& bgr, PictureFormat format, double pixel) {
  std::vector<std::uint8_t> bytes;
  if (format == PictureFormat::png) {
    cv::imencode(".png", bgr, bytes);
    insert_pixel_size(bytes, pixel);
    return bytes;
  }
  std::vector<int> parameters{cv::IMWRITE_TIFF_COMPRESSION, kDeflate};
  const double per_centimetre = std::round(kMicrometresPerCentimetre / pixel);
  if (per_centimetre >= 1.0 && per_centimetre <= std::numeric_limits<int>::max()) {
    const int resolution = static_cast<int>(per_centimetre);
    parameters.insert(parameters.end(),
                      {cv::IMWRITE_TIFF_RESUNIT, kCentimetres, cv::IMWRITE_TIFF_XDPI, resolution,
                       cv::IMWRITE_TIFF_YDPI, resolution});
  }
  cv::imencode(".tif", bgr, bytes, parameters);
  return bytes;
}

}  // namespace

PictureFormat picture_format(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  if (extension == ".png") {
    return PictureFormat::png;
  }
  if (extension == ".tif" || extension == ".tiff") {
    return PictureFormat::tiff;
  }
  throw InvalidRequest("'" + path.string() +
                       "' is no picture that can be written: name it .png, .tif or .tiff");
}

void write_section_image(const std::filesystem::path& path, const cv::Mat& image, double pixel) {
  const PictureFormat format = picture_format(path);
  std::vector<std::uint8_t> bytes;
  try {
    cv::Mat bgr;
    cv::cvtColor(image, bgr, cv::COLOR_RGB2BGR);
    bytes = encode(bgr, format, pixel);
  } catch (const cv::Exception& error) {
    throw SampleError(path.string() + ": the picture can't be encoded: " + error.err);
  }
  write_durably(path, std::as_bytes(std::span(bytes)));
}

}  // namespace biotomy::reconstruct
