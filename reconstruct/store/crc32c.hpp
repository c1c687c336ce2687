#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace biotomy::reconstruct {

/// CRC-32C (Castagnoli; RFC 3720, appendix B.4), the checksum of Zarr's codec `crc32c`. By the
/// processor's instruction where there is one, as it is taken of every chunk that is read.
std::uint32_t crc32c(std::span<const std::byte> bytes);

/// The same by tables alone, on any processor.
std::uint32_t crc32c_by_tables(std::span<const std::byte> bytes);

}  // namespace biotomy::reconstruct
