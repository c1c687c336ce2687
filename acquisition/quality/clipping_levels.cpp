#include "acquisition/quality/clipping_levels.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

namespace biotomy::acquisition {
namespace {

constexpr int kRows = 512;                ///< enough to tell how frequent a value is
constexpr int kLevels = 256;              ///< of a scale, as in 8 bits, whatever its bits
constexpr int kNearTheEnd = 6;            ///< levels: JPEG leaves so many about a plateau
constexpr std::ptrdiff_t kJustBelow = 3;  ///< levels: of 8 bits in 16, some values are among them
constexpr int kVeryLast = 2;              ///< levels
constexpr std::int64_t kPile = 4;         ///< times as frequent as what lies below
constexpr std::int64_t kTailShare = 8;  ///< of what is near the end, at most so many times the last

/// Fewer values of a colour than this part are no matter, and may be hot pixels.
constexpr double kLeastShare = 1e-4;
constexpr std::int64_t kLeast = 8;

/// How often each value of a colour is there.
using Histogram = std::vector<std::int64_t>;

template <typename Sample>
Histogram histogram_of(const cv::Mat& image, int colour) {
  std::vector<std::uint32_t> counts(1UL + std::numeric_limits<Sample>::max());
  const int step = std::max(1, image.rows / kRows);
  for (int y = 0; y < image.rows; y += step) {
    const Sample* value = image.ptr<Sample>(y) + colour;
    for (int x = 0; x < image.cols; ++x, value += 3) ++counts[*value];
  }
  return {counts.begin(), counts.end()};
}

std::int64_t sum(const Histogram& histogram, int first, int end) {
  return std::accumulate(histogram.begin() + first, histogram.begin() + end, std::int64_t{0});
}

int largest_of(const Histogram& histogram) {
  const auto is_there = [](std::int64_t count) { return count > 0; };
  const auto found = std::find_if(histogram.rbegin(), histogram.rend(), is_there);
  return static_cast<int>(histogram.rend() - found) - 1;
}

/// One more than the largest value that the camera can give.
int scale_of(const std::array<Histogram, 3>& colours) {
  int largest = 0;
  for (const Histogram& colour : colours) largest = std::max(largest, largest_of(colour));
  const auto values = static_cast<int>(colours[0].size());
  for (const int bits : {10, 12, 14}) {
    if (largest < 1 << bits) return std::min(1 << bits, values);
  }
  return values;
}

int clipping_level(const Histogram& histogram, int scale) {
  const int level = scale / kLevels;
  const int near = scale - kNearTheEnd * level;
  const std::int64_t piled = sum(histogram, near, scale);
  const std::int64_t all = sum(histogram, 0, scale);
  const auto enough =
      std::max(kLeast, static_cast<std::int64_t>(kLeastShare * static_cast<double>(all)));
  const int full = static_cast<int>(histogram.size()) - 1;

  const bool is_of_eight_bits = level == 1;
  if (is_of_eight_bits && piled >= enough &&
      piled >= kPile * sum(histogram, near - kNearTheEnd, near) &&
      kTailShare * sum(histogram, scale - kVeryLast, scale) >= piled) {
    return near;
  }
  const auto most = std::max_element(histogram.begin() + near, histogram.begin() + scale);
  const std::int64_t beside = *std::max_element(most - kJustBelow * level, most);
  if (*most >= enough && *most >= kPile * beside) {
    return static_cast<int>(most - histogram.begin());
  }
  return full;
}

}  // namespace

ClippingLevels clipping_levels(const cv::Mat& image) {
  std::array<Histogram, 3> colours;
  cv::parallel_for_({0, 3}, [&](const cv::Range& range) {
    for (int c = range.start; c < range.end; ++c) {
      colours.at(static_cast<std::size_t>(c)) = image.depth() == CV_16U
                                                    ? histogram_of<std::uint16_t>(image, c)
                                                    : histogram_of<std::uint8_t>(image, c);
    }
  });
  const int scale = scale_of(colours);
  ClippingLevels levels{};
  for (std::size_t c = 0; c < levels.size(); ++c) levels[c] = clipping_level(colours[c], scale);
  return levels;
}

}  // namespace biotomy::acquisition
