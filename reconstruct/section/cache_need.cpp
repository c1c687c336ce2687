#include "reconstruct/section/cache_need.hpp"

#include <algorithm>

namespace biotomy::reconstruct {

std::size_t cache_for_one_section(int columns, int bits) {
  constexpr std::size_t kLeastBytes = 16'000'000;
  constexpr std::size_t kBytesForAColumn = 17'000;  // of 8 bits; ample at scale: run_scale
  return std::max(kLeastBytes, static_cast<std::size_t>(columns) * kBytesForAColumn) *
         static_cast<std::size_t>(bits / 8);
}

}  // namespace biotomy::reconstruct
