#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace biotomy::reconstruct {

/// DEFLATE (RFC 1951) for the filtered rows of pictures: Huffman codes made for each block, and
/// runs of one byte as the only matches. What filters leave of photographs is noise around zero, in
/// which a search for longer matches finds next to nothing and takes nearly all the time; what they
/// leave of an even background is a run. Any inflater reads it.
///
/// Appends the blocks of `plain` to `out`. They end on a whole byte, so that the pieces of a stream
/// can be made in any order and joined; the `last` piece ends the stream. An empty piece is
/// allowed.
void deflate_runs(std::span<const std::uint8_t> plain, bool last, std::vector<std::byte>& out);

/// The same as a zlib stream of its own (RFC 1950).
std::vector<std::byte> zlib_stream_of_runs(std::span<const std::uint8_t> plain);

/// The two bytes that such a stream begins with.
inline constexpr std::array<std::uint8_t, 2> kZlibHeader{0x78, 0x01};

}  // namespace biotomy::reconstruct
