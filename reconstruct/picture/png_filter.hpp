#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace biotomy::reconstruct {

/// The filters of PNG that help with photographs (PNG, third edition, section 9).
enum class PngFilter : std::uint8_t { sub = 1, up = 2, average = 3, paeth = 4 };

/// Filters one row. `out` gets the filter's number and then the row: one byte more than `row`.
/// `above` is the row above, zeros for the first; `step` is the bytes of a pixel.
void filter_png_row(PngFilter filter, std::span<const std::uint8_t> row,
                    std::span<const std::uint8_t> above, std::size_t step,
                    std::span<std::uint8_t> out);

/// The filter that leaves the least sum of absolute differences of this row, read as signed bytes:
/// the specification's own rule of thumb (section 12.7).
PngFilter best_png_filter(std::span<const std::uint8_t> row, std::span<const std::uint8_t> above,
                          std::size_t step);

}  // namespace biotomy::reconstruct
