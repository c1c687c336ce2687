#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "reconstruct/store/crc32c.hpp"

namespace biotomy::tests {

/// The bytes and after them their CRC-32C, little-endian, as an index and a chunk of ours end.
inline std::vector<std::byte> with_checksum(std::span<const std::byte> bytes) {
  std::vector<std::byte> whole(bytes.begin(), bytes.end());
  const auto crc = reconstruct::crc32c(bytes);
  for (int shift = 0; shift < 32; shift += 8) {
    whole.push_back(static_cast<std::byte>(crc >> shift));
  }
  return whole;
}

}  // namespace biotomy::tests
