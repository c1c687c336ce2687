#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

namespace biotomy::reconstruct {

/// The eight bytes that a PNG begins with (PNG, third edition, section 5.2).
inline constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P',  'N',  'G',
                                                           '\r', '\n', 0x1A, '\n'};

/// A number as PNG stores it: the highest byte first. `bytes` holds four at least.
inline std::uint32_t png_number(std::span<const std::byte> bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    number = number << 8 | std::to_integer<std::uint32_t>(bytes[i]);
  }
  return number;
}

/// A chunk of a PNG in memory (section 5.3).
struct PngChunk {
  std::span<const std::byte> whole;  ///< length, type, data, CRC

  std::span<const std::byte> data() const { return whole.subspan(8, whole.size() - 12); }
  /// What the CRC is taken of: type and data.
  std::span<const std::byte> covered() const { return whole.subspan(4, whole.size() - 8); }
  std::uint32_t crc() const { return png_number(whole.last(4)); }
  bool is(std::string_view type) const {
    return std::memcmp(whole.data() + 4, type.data(), type.size()) == 0;
  }
};

/// The chunk that begins at `position` of the file, of which nothing is checked but that it is all
/// there; none if it is not.
inline std::optional<PngChunk> png_chunk_at(std::span<const std::byte> file, std::size_t position) {
  constexpr std::size_t kFrame = 12;  // length, type, CRC
  if (position > file.size() || file.size() - position < kFrame) {
    return std::nullopt;
  }
  const std::size_t length = png_number(file.subspan(position));
  if (length > file.size() - position - kFrame) {
    return std::nullopt;
  }
  return PngChunk{file.subspan(position, length + kFrame)};
}

inline bool is_png(std::span<const std::byte> file) {
  return file.size() >= kPngSignature.size() &&
         std::memcmp(file.data(), kPngSignature.data(), kPngSignature.size()) == 0;
}

}  // namespace biotomy::reconstruct
