#include "reconstruct/picture/picture_description.hpp"

#include <array>
#include <cstddef>
#include <fstream>
#include <span>
#include <string_view>

#include "reconstruct/errors.hpp"
#include "reconstruct/picture/png_chunk.hpp"
#include "reconstruct/picture/tiff_file.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = std::size_t{1} << 20;
constexpr const char* kTooLong = ": says more of itself than 1 MiB";

/// The keyword of a text and what follows it: not compressed, of no stated language.
constexpr std::string_view kPngKeyword{"Description\0\0\0\0\0", 16};

enum class Format { png, tiff, other };

Format format_of(std::span<const std::byte> start) {
  const std::string_view text(reinterpret_cast<const char*>(start.data()), start.size());
  if (is_png(start)) {
    return Format::png;
  }
  return text.starts_with("II") || text.starts_with("MM") ? Format::tiff : Format::other;
}

std::optional<std::string> in_png(std::ifstream& file, const fs::path& path) {
  constexpr std::size_t kBeforeData = 8;  // length and type
  constexpr std::streamoff kCrc = 4;
  std::array<char, kBeforeData> frame{};
  while (file.read(frame.data(), frame.size())) {
    const std::size_t length = png_number(std::as_bytes(std::span(frame)));
    if (std::string_view(frame.data() + 4, 4) != "iTXt") {
      file.seekg(static_cast<std::streamoff>(length) + kCrc, std::ios::cur);
      continue;
    }
    if (length > kMostBytes) {
      throw SampleError(path.string() + kTooLong);
    }
    std::string text(length, '\0');
    if (!file.read(text.data(), static_cast<std::streamsize>(length))) {
      throw SampleError(path.string() + ": is cut off");
    }
    if (text.starts_with(kPngKeyword)) {
      return text.substr(kPngKeyword.size());
    }
    file.seekg(kCrc, std::ios::cur);
  }
  return std::nullopt;
}

std::optional<std::string> in_tiff(const fs::path& path) {
  auto text = TiffFile::open(path).text(TIFFTAG_IMAGEDESCRIPTION);
  if (text && text->size() > kMostBytes) {
    throw SampleError(path.string() + kTooLong);
  }
  return text;
}

}  // namespace

std::optional<std::string> picture_description(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, kPngSignature.size()> start{};
  if (!file.read(start.data(), start.size())) {
    throw SampleError(path.string() + ": cannot be read, or is too short for a picture");
  }
  switch (format_of(std::as_bytes(std::span(start)))) {
    case Format::png:
      return in_png(file, path);
    case Format::tiff:
      return in_tiff(path);
    case Format::other:
      break;
  }
  return std::nullopt;
}

}  // namespace biotomy::reconstruct
