#pragma once

#include <cstddef>

namespace biotomy::reconstruct {

/// Bytes of decoded chunks that cutting one section can use. It needs the chunks of two strips of
/// its rows at a time; memory for more would only be filled once, and filling fresh memory takes as
/// long as decoding. `bits` are those of one colour.
std::size_t cache_for_one_section(int columns, int bits);

}  // namespace biotomy::reconstruct
