#include "reconstruct/picture/image_file.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <new>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/image_integrity.hpp"
#include "reconstruct/picture/jpeg_reader.hpp"
#include "reconstruct/picture/png_reader.hpp"
#include "reconstruct/picture/tiff_image.hpp"

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

cv::Mat decode(std::span<const std::byte> bytes, Format format) {
  const bool png = format == Format::png;
  if (const auto damage = png ? png_damage(bytes) : jpeg_damage(bytes)) {
    throw SampleError("is damaged: " + *damage);
  }
  return png ? decode_png(bytes) : decode_jpeg(bytes);
}

cv::Mat read_by_format(const fs::path& path) {
  const Format format = format_of_name(path);
  if (format == Format::tiff) {
    return read_tiff_image(path);
  }
  if (format == Format::unknown) {
    throw SampleError(path.string() + ": is not a PNG, TIFF or JPEG by its name");
  }
  const std::vector<std::byte> bytes = read_whole(path);
  try {
    return decode(bytes, format);
  } catch (const SampleError& error) {
    throw SampleError(path.string() + ": " + error.what());
  }
}

/// What `read` returns; its complaints of memory name the file.
template <typename Read>
cv::Mat with_memory_for(const fs::path& path, const Read& read) {
  constexpr const char* kNoMemory = ": there is no memory for the picture";
  try {
    return read();
  } catch (const cv::Exception&) {
    throw SampleError(path.string() + kNoMemory);
  } catch (const std::bad_alloc&) {
    throw SampleError(path.string() + kNoMemory);
  }
}

}  // namespace

bool is_image_name(const fs::path& path) {
  return format_of_name(path) != Format::unknown;
}

bool is_tiff_name(const fs::path& path) {
  return format_of_name(path) == Format::tiff;
}

cv::Mat read_image_file(const fs::path& path) {
  return with_memory_for(path, [&] { return read_by_format(path); });
}

cv::Mat read_image_page(const fs::path& path, TiffPage page) {
  return with_memory_for(path, [&] { return read_tiff_page(path, page); });
}

}  // namespace biotomy::reconstruct
