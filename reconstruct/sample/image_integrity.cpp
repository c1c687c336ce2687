#include "reconstruct/sample/image_integrity.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include <zlib.h>

namespace biotomy::reconstruct {
namespace {

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kPngChunkFrame = 12;  // length, type, CRC

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

std::uint32_t big_endian_32(std::span<const std::byte> file, std::size_t position) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    number = number << 8 | byte_at(file, position + i);
  }
  return number;
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
  if (file.size() < kPngSignature.size() ||
      std::memcmp(file.data(), kPngSignature.data(), kPngSignature.size()) != 0) {
    return "it is not a PNG";
  }
  std::size_t position = kPngSignature.size();
  while (file.size() - position >= kPngChunkFrame) {
    const std::size_t length = big_endian_32(file, position);
    if (length > file.size() - position - kPngChunkFrame) {
      return "it is truncated";
    }
    // The CRC covers the type and the data.
    const auto covered = file.subspan(position + 4, length + 4);
    const auto crc = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(covered.data()), covered.size()));
    if (crc != big_endian_32(file, position + 8 + length)) {
      return "a checksum in it is wrong";
    }
    if (std::memcmp(covered.data(), "IEND", 4) == 0) {
      return std::nullopt;
    }
    position += length + kPngChunkFrame;
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
