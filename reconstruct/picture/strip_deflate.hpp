#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace biotomy::reconstruct {

/// DEFLATE (RFC 1951) by zlib for the filtered rows of pictures: runs of one byte are the only
/// matches. What filters leave of photographs is noise around zero, in which a search for longer
/// matches finds next to nothing and takes most of the time.
///
/// Appends the blocks of `plain` to `out`. They end on a whole byte and refer to nothing before, so
/// that the strips of a stream can be compressed in any order and joined; the `last` ends the
/// stream. An empty strip is allowed.
void deflate_strip(std::span<const std::uint8_t> plain, bool last, std::vector<std::byte>& out);

/// A strip as a zlib stream of its own (RFC 1950).
std::vector<std::byte> zlib_stream(std::span<const std::uint8_t> plain);

/// The two bytes that such a stream begins with.
inline constexpr std::array<std::uint8_t, 2> kZlibHeader{0x78, 0x01};

}  // namespace biotomy::reconstruct
