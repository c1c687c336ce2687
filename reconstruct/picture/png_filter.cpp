#include "reconstruct/picture/png_filter.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <vector>

namespace biotomy::reconstruct {
namespace {

// All loops below are written so that compilers make vector code of them: no branch depends on a
// pixel.

int paeth_predictor(int left, int above, int corner) {
  const int to_left = std::abs(above - corner);
  const int to_above = std::abs(left - corner);
  const int to_corner = std::abs(left + above - 2 * corner);
  const int other = to_above <= to_corner ? above : corner;
  return to_left <= to_above && to_left <= to_corner ? left : other;
}

/// `predict(left, above, corner)`; left of the first pixel everything is zero.
template <typename Predict>
void filter(std::span<const std::uint8_t> row, std::span<const std::uint8_t> above,
            std::size_t step, std::uint8_t* out, Predict predict) {
  for (std::size_t i = 0; i < std::min(step, row.size()); ++i) {
    out[i] = static_cast<std::uint8_t>(row[i] - predict(0, above[i], 0));
  }
  const std::uint8_t* const here = row.data();
  const std::uint8_t* const up_there = above.data();
  const std::size_t size = row.size();
  for (std::size_t i = step; i < size; ++i) {
    out[i] = static_cast<std::uint8_t>(here[i] -
                                       predict(here[i - step], up_there[i], up_there[i - step]));
  }
}

std::uint64_t magnitude(std::span<const std::uint8_t> differences) {
  constexpr std::size_t kPart = 4096;  // whose sum fits into 32 bits
  std::uint64_t total = 0;
  while (!differences.empty()) {
    const auto part = differences.first(std::min(kPart, differences.size()));
    std::uint32_t sum = 0;
    for (const std::uint8_t each : part) {
      const auto shifted = static_cast<std::uint8_t>(each ^ 0x80U);
      sum += static_cast<unsigned>(std::abs(shifted - 0x80));
    }
    total += sum;
    differences = differences.subspan(part.size());
  }
  return total;
}

}  // namespace

void filter_png_row(PngFilter kind, std::span<const std::uint8_t> row,
                    std::span<const std::uint8_t> above, std::size_t step,
                    std::span<std::uint8_t> out) {
  out[0] = static_cast<std::uint8_t>(kind);
  std::uint8_t* const rest = out.data() + 1;
  switch (kind) {
    case PngFilter::sub:
      filter(row, above, step, rest, [](int left, int, int) { return left; });
      return;
    case PngFilter::up:
      filter(row, above, step, rest, [](int, int over, int) { return over; });
      return;
    case PngFilter::average:
      filter(row, above, step, rest, [](int left, int over, int) { return (left + over) >> 1; });
      return;
    case PngFilter::paeth:
      filter(row, above, step, rest,
             [](int left, int over, int corner) { return paeth_predictor(left, over, corner); });
      return;
  }
}

PngFilter best_png_filter(std::span<const std::uint8_t> row, std::span<const std::uint8_t> above,
                          std::size_t step) {
  PngFilter best = PngFilter::up;
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  std::vector<std::uint8_t> trial(row.size() + 1);
  for (const PngFilter each :
       {PngFilter::up, PngFilter::sub, PngFilter::average, PngFilter::paeth}) {
    filter_png_row(each, row, above, step, trial);
    const std::uint64_t sum = magnitude(std::span(trial).subspan(1));
    if (sum < least) {
      least = sum;
      best = each;
    }
  }
  return best;
}

}  // namespace biotomy::reconstruct
