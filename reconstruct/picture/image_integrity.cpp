#include "reconstruct/picture/image_integrity.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <libdeflate.h>

#include "reconstruct/picture/png_chunk.hpp"

namespace biotomy::reconstruct {
namespace {

// Second bytes of JPEG markers; the first is 0xFF.
constexpr std::uint8_t kMarkerPrefix = 0xFF;
constexpr std::uint8_t kStuffing = 0x00;
constexpr std::uint8_t kTemporary = 0x01;
constexpr std::uint8_t kFirstRestart = 0xD0;
constexpr std::uint8_t kLastRestart = 0xD7;
constexpr std::uint8_t kStartOfImage = 0xD8;
constexpr std::uint8_t kEndOfImage = 0xD9;
constexpr std::uint8_t kStartOfScan = 0xDA;

std::uint8_t byte_at(std::span<const std::byte> file, std::size_t position) {
  return std::to_integer<std::uint8_t>(file[position]);
}

/// The position of the marker that ends the entropy-coded data at `position`; the file's size when
/// there is none.
std::size_t end_of_scan(std::span<const std::byte> file, std::size_t position) {
  while (position + 1 < file.size()) {
    const void* found =
        std::memchr(file.data() + position, kMarkerPrefix, file.size() - position - 1);
    if (found == nullptr) {
      break;
    }
    position = static_cast<std::size_t>(static_cast<const std::byte*>(found) - file.data());
    const std::uint8_t code = byte_at(file, position + 1);
    if (code == kMarkerPrefix) {
      ++position;  // a fill byte
    } else if (code == kStuffing || (code >= kFirstRestart && code <= kLastRestart)) {
      position += 2;
    } else {
      return position;
    }
  }
  return file.size();
}

}  // namespace

std::optional<std::string> png_damage(std::span<const std::byte> file) {
  if (!is_png(file)) {
    return "it is not a PNG";
  }
  std::size_t position = kPngSignature.size();
  while (const auto chunk = png_chunk_at(file, position)) {
    if (libdeflate_crc32(0, chunk->covered().data(), chunk->covered().size()) != chunk->crc()) {
      return "a checksum in it is wrong";
    }
    if (chunk->is("IEND")) {
      return std::nullopt;
    }
    position += chunk->whole.size();
  }
  return "it is truncated";
}

std::optional<std::string> jpeg_damage(std::span<const std::byte> file) {
  if (file.size() < 2 || byte_at(file, 0) != kMarkerPrefix || byte_at(file, 1) != kStartOfImage) {
    return "it is not a JPEG";
  }
  bool has_scan = false;
  std::size_t position = 2;
  while (position + 1 < file.size()) {
    if (byte_at(file, position) != kMarkerPrefix) {
      return "there is no marker where one must be";
    }
    const std::uint8_t code = byte_at(file, position + 1);
    if (code == kEndOfImage) {
      return has_scan ? std::nullopt : std::optional<std::string>("there is no image in it");
    }
    if (code == kMarkerPrefix) {
      ++position;  // a fill byte
      continue;
    }
    if (code == kTemporary || (code >= kFirstRestart && code <= kLastRestart)) {
      position += 2;  // markers that stand alone
      continue;
    }
    if (position + 3 >= file.size()) {
      break;
    }
    const std::size_t length =
        static_cast<std::size_t>(byte_at(file, position + 2)) << 8 | byte_at(file, position + 3);
    if (length < 2) {
      return "the length of a segment makes no sense";
    }
    position += 2 + length;
    if (code == kStartOfScan) {
      has_scan = true;
      position = end_of_scan(file, std::min(position, file.size()));
    }
  }
  return "it is truncated";
}

}  // namespace biotomy::reconstruct
