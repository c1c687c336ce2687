#include "reconstruct/store/crc32c.hpp"

#include <algorithm>
#include <limits>

#include <isa-l/crc.h>

namespace biotomy::reconstruct {

std::uint32_t crc32c(std::span<const std::byte> bytes) {
  constexpr std::size_t kMost = std::numeric_limits<int>::max();  // that ISA-L takes at once
  std::uint32_t crc = 0xFFFFFFFF;
  while (!bytes.empty()) {
    const auto part = bytes.first(std::min(bytes.size(), kMost));
    // ISA-L only reads, though its signature does not say so.
    auto* const data = reinterpret_cast<unsigned char*>(const_cast<std::byte*>(part.data()));
    crc = crc32_iscsi(data, static_cast<int>(part.size()), crc);
    bytes = bytes.subspan(part.size());
  }
  return ~crc;
}

}  // namespace biotomy::reconstruct
