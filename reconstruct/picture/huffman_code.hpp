#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace biotomy::reconstruct {

/// A canonical prefix code as DEFLATE wants it (RFC 1951, 3.2.2).
struct HuffmanCode {
  std::vector<std::uint8_t> lengths;  ///< of each symbol, bits; 0 for one that does not occur
  std::vector<std::uint16_t> codes;   ///< first bit lowest, ready to be written
};

/// The shortest code for symbols that occur `counts` times, none longer than `longest` bits (or
/// nearly the shortest where that limit binds). Symbols that do not occur get no code; a symbol
/// that is alone gets one of 1 bit. 2^longest must be at least the number of symbols.
HuffmanCode huffman_code(std::span<const std::uint32_t> counts, int longest);

}  // namespace biotomy::reconstruct
