#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace biotomy::reconstruct {

/// A PNG whose pixels are stored and no longer compressed, still filtered, as the parts that its
/// file would be made of. libpng reads it as any other, and is spared what takes most of its time:
/// it inflates with zlib, for which libdeflate takes less than half the time.
class InflatedPng {
 public:
  /// None where libpng has to read the file as it is: one that is interlaced, or in which anything
  /// is not as it must be, so that libpng says what. `file` must outlive the parts.
  static std::optional<InflatedPng> of(std::span<const std::byte> file);

  /// In their order.
  const std::vector<std::span<const std::byte>>& parts() const { return parts_; }

 private:
  using StreamStart = std::array<std::byte, 10>;  // header of a chunk and of a zlib stream
  using BlockStart = std::array<std::byte, 5>;    // of a stored block (RFC 1951, section 3.2.4)
  using StreamEnd = std::array<std::byte, 8>;     // Adler-32 of the stream, CRC of the chunk

  explicit InflatedPng(std::unique_ptr<std::byte[]> pixels) : pixels_(std::move(pixels)) {}
  void add_stream(std::size_t bytes);

  std::unique_ptr<std::byte[]> pixels_;
  std::unique_ptr<StreamStart> start_;
  std::vector<BlockStart> block_starts_;
  std::unique_ptr<StreamEnd> end_;
  std::vector<std::span<const std::byte>> parts_;
};

}  // namespace biotomy::reconstruct
