#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace biotomy::reconstruct {

/// CRC-32C (Castagnoli; RFC 3720, appendix B.4), the checksum of Zarr's codec `crc32c`.
std::uint32_t crc32c(std::span<const std::byte> bytes);

}  // namespace biotomy::reconstruct
