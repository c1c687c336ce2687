#include "acquisition/quality/shared_detail.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

#include "acquisition/quality/clipping_levels.hpp"

namespace biotomy::acquisition {
namespace {

constexpr float kLeftOut = std::numeric_limits<float>::quiet_NaN();  ///< and all that is made of it

/// The two images of one scene.
struct Twins {
  cv::Mat falling;  ///< of the pixels on the diagonal that falls to the right, CV_32FC1
  cv::Mat rising;
};

/// The brightness (R + 2 G + B)/4 of the two diagonals of 2 × 2 pixels, of full scale.
template <typename Sample>
void split_row(const Sample* upper, const Sample* lower, const ClippingLevels& levels, int width,
               float* falling, float* rising) {
  constexpr float kScale = 1.0F / (8.0F * static_cast<float>(std::numeric_limits<Sample>::max()));
  bool clipped = false;
  const auto brightness = [&](const Sample* pixel) {
    clipped = clipped || is_clipped(pixel, levels);
    return pixel[0] + 2 * pixel[1] + pixel[2];
  };
  for (int x = 0; x < width; ++x, upper += 6, lower += 6) {
    clipped = false;
    const int falls = brightness(upper) + brightness(lower + 3);
    const int rises = brightness(upper + 3) + brightness(lower);
    falling[x] = clipped ? kLeftOut : kScale * static_cast<float>(falls);
    rising[x] = clipped ? kLeftOut : kScale * static_cast<float>(rises);
  }
}

Twins split(const cv::Mat& image, const cv::Mat& usable) {
  const cv::Size half(image.cols / 2, image.rows / 2);
  Twins twins{cv::Mat(half, CV_32FC1), cv::Mat(half, CV_32FC1)};
  const ClippingLevels levels = clipping_levels(image);
  cv::parallel_for_({0, half.height}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      auto* falling = twins.falling.ptr<float>(y);
      auto* rising = twins.rising.ptr<float>(y);
      if (image.depth() == CV_16U) {
        split_row(image.ptr<std::uint16_t>(2 * y), image.ptr<std::uint16_t>(2 * y + 1), levels,
                  half.width, falling, rising);
      } else {
        split_row(image.ptr<std::uint8_t>(2 * y), image.ptr<std::uint8_t>(2 * y + 1), levels,
                  half.width, falling, rising);
      }
      const auto* may_be_seen = usable.ptr<std::uint8_t>(y);
      for (int x = 0; x < half.width; ++x) {
        if (may_be_seen[x] == 0) falling[x] = kLeftOut;
      }
    }
  });
  return twins;
}

cv::Mat halved(const cv::Mat& plane) {
  cv::Mat half(plane.rows / 2, plane.cols / 2, CV_32FC1);
  for (int y = 0; y < half.rows; ++y) {
    const auto* upper = plane.ptr<float>(2 * y);
    const auto* lower = plane.ptr<float>(2 * y + 1);
    auto* out = half.ptr<float>(y);
    for (int x = 0; x < half.cols; ++x) {
      const std::ptrdiff_t left = 2L * x;
      out[x] = 0.25F * (upper[left] + upper[left + 1] + lower[left] + lower[left + 1]);
    }
  }
  return half;
}

/// A tile in a plane of a `scale`-th of the resolution, with room for what the differences reach.
cv::Rect inner_part(const cv::Rect& tile, const cv::Mat& plane, int scale) {
  const cv::Rect part(tile.x / scale, tile.y / scale, tile.width / scale, tile.height / scale);
  return part & cv::Rect(1, 1, plane.cols - 2, plane.rows - 2);
}

SharedDetail shared_detail(const Twins& twins, const cv::Rect& part) {
  SharedDetail detail;
  for (int y = part.y; y < part.br().y; ++y) {
    const auto* a_above = twins.falling.ptr<float>(y - 1);
    const auto* a = twins.falling.ptr<float>(y);
    const auto* a_below = twins.falling.ptr<float>(y + 1);
    const auto* b_above = twins.rising.ptr<float>(y - 1);
    const auto* b = twins.rising.ptr<float>(y);
    const auto* b_below = twins.rising.ptr<float>(y + 1);
    float shared = 0.0F;
    float own = 0.0F;
    float count = 0.0F;
#pragma omp simd reduction(+ : shared, own, count)
    for (int x = part.x; x < part.br().x; ++x) {
      const float a_along = a[x - 1] - 2.0F * a[x] + a[x + 1];
      const float b_along = b[x - 1] - 2.0F * b[x] + b[x + 1];
      const float a_across = a_above[x] - 2.0F * a[x] + a_below[x];
      const float b_across = b_above[x] - 2.0F * b[x] + b_below[x];
      const float product = a_along * b_along + a_across * b_across;
      const float squares =
          a_along * a_along + b_along * b_along + a_across * a_across + b_across * b_across;
      const bool counts = product == product;
      shared += counts ? product : 0.0F;
      own += counts ? 0.5F * squares : 0.0F;
      count += counts ? 1.0F : 0.0F;
    }
    detail.shared += static_cast<double>(shared);
    detail.own += static_cast<double>(own);
    detail.count += static_cast<double>(count);
  }
  return detail;
}

double brightness_of_part(const cv::Mat& plane, const cv::Rect& part) {
  double sum = 0.0;
  double count = 0.0;
  for (int y = part.y; y < part.br().y; ++y) {
    const auto* row = plane.ptr<float>(y);
    for (int x = part.x; x < part.br().x; ++x) {
      const bool counts = row[x] == row[x];
      sum += counts ? static_cast<double>(row[x]) : 0.0;
      count += counts ? 1.0 : 0.0;
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

std::vector<TileDetail> measure_shared_detail(const cv::Mat& image, const TileGrid& grid,
                                              const cv::Mat& usable) {
  std::array<Twins, kDetailScales> scales{split(image, usable)};
  for (std::size_t i = 1; i < scales.size(); ++i) {
    scales[i] = {halved(scales[i - 1].falling), halved(scales[i - 1].rising)};
  }
  std::vector<TileDetail> tiles(static_cast<std::size_t>(grid.count()));
  cv::parallel_for_({0, grid.count()}, [&](const cv::Range& numbers) {
    for (int number = numbers.start; number < numbers.end; ++number) {
      TileDetail& tile = tiles[static_cast<std::size_t>(number)];
      const auto part = [&](std::size_t scale) {
        return inner_part(grid.tile(number), scales[scale].falling, 2 << scale);
      };
      tile.brightness = brightness_of_part(scales[0].falling, part(0));
      for (std::size_t i = 0; i < scales.size(); ++i) {
        tile.scales[i] = shared_detail(scales[i], part(i));
      }
    }
  });
  return tiles;
}

}  // namespace biotomy::acquisition
