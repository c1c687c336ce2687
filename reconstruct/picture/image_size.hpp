#pragma once

#include <cstdint>
#include <limits>

namespace biotomy::reconstruct {

/// Pixels along a side; what is longer makes no sense and is refused before memory is asked for it.
inline constexpr std::uint64_t kLongestSide = std::uint64_t{1} << 20;

/// Whether an image of that size makes sense; its pixels can then be counted by an int, as OpenCV
/// does.
inline bool is_image_size(std::uint64_t width, std::uint64_t height) {
  return width > 0 && height > 0 && width <= kLongestSide && height <= kLongestSide &&
         width * height <= std::numeric_limits<std::int32_t>::max();
}

}  // namespace biotomy::reconstruct
