#include "acquisition/quality/frame_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <opencv2/core/utility.hpp>

namespace biotomy::acquisition {
namespace {

constexpr float kClipped = std::numeric_limits<float>::quiet_NaN();  ///< and all that is made of it
constexpr double kSobelNoise = 3.0 / 16.0;  ///< the sum of the squared weights, see the header
constexpr double kCurvatureNoise = 6.0;     ///< likewise of 1 -2 1
constexpr double kImmerkaerNoise = 36.0;    ///< likewise of (1 -2 1) × (1 -2 1)

/// How far a tile's gradients reach beyond it, in its own pixels: one pixel of the coarsest level
/// and one for the gradient there.
constexpr int kReach = 8;

/// Rows are summed in single, tiles in double precision.
struct Mean {
  double sum = 0.0;
  double count = 0.0;

  void add(float row_sum, float row_count) {
    sum += static_cast<double>(row_sum);
    count += static_cast<double>(row_count);
  }
  double value() const { return count > 0.0 ? sum / count : 0.0; }
};

struct Colours {
  std::array<Mean, 3> means;
  double clipped = 0.0;
};

/// The brightness of a row, (R + 2 G + B)/4 of full scale.
template <typename Sample>
void brightness_of_row(const Sample* pixels, int width, const ClippingLevels& levels,
                       float* brightness) {
  constexpr float kScale = 0.25F / static_cast<float>(std::numeric_limits<Sample>::max());
  for (int x = 0; x < width; ++x, pixels += 3) {
    const auto sum = static_cast<float>(static_cast<std::uint32_t>(pixels[0]) +
                                        2U * static_cast<std::uint32_t>(pixels[1]) +
                                        static_cast<std::uint32_t>(pixels[2]));
    brightness[x] = is_clipped(pixels, levels) ? kClipped : kScale * sum;
  }
}

template <typename Sample>
void add_colours(const Sample* pixels, const float* brightness, int width, Colours& colours) {
  std::array<std::uint64_t, 3> sums{};
  std::uint64_t counted = 0;
  for (int x = 0; x < width; ++x, pixels += 3) {
    const std::uint32_t counts = brightness[x] == brightness[x] ? 1U : 0U;
    for (std::size_t c = 0; c < 3; ++c) sums[c] += static_cast<std::uint64_t>(counts) * pixels[c];
    counted += counts;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    colours.means[c].sum += static_cast<double>(sums[c]) / std::numeric_limits<Sample>::max();
    colours.means[c].count += static_cast<double>(counted);
  }
  colours.clipped += static_cast<double>(static_cast<std::uint64_t>(width) - counted);
}

/// Rows of a picture in one block of memory, with room for the neighbours of the first and last.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<float> values;

  void resize(int columns, int rows) {
    width = columns;
    height = rows;
    values.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  }
  float* row(int y) {
    return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
  const float* row(int y) const {
    return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
};

void halve(const Plane& from, Plane& to) {
  to.resize(from.width / 2, from.height / 2);
  for (int y = 0; y < to.height; ++y) {
    const float* upper = from.row(2 * y);
    const float* lower = from.row(2 * y + 1);
    float* out = to.row(y);
    for (int x = 0; x < to.width; ++x) {
      const std::ptrdiff_t left = 2L * x;
      out[x] = 0.25F * (upper[left] + upper[left + 1] + lower[left] + lower[left + 1]);
    }
  }
}

/// Sobel's gradients at a place of a row, along it and across the rows.
inline float gradient_along(const float* above, const float* here, const float* below, int i) {
  return 0.125F * ((above[i + 1] + 2.0F * here[i + 1] + below[i + 1]) -
                   (above[i - 1] + 2.0F * here[i - 1] + below[i - 1]));
}
inline float gradient_across(const float* above, const float* below, int i) {
  return 0.125F * ((below[i - 1] + 2.0F * below[i] + below[i + 1]) -
                   (above[i - 1] + 2.0F * above[i] + above[i + 1]));
}

/// All that is measured of the picture itself, with the noise still in it.
struct FullResolution {
  DetailEnergy curvature;
  DetailEnergy gradient;
  double noise_variance = 0.0;
};

/// Over an inner part of a plane. A pixel counts when all its neighbours are numbers.
FullResolution look_closely(const Plane& plane, const cv::Rect& part) {
  Mean xx;
  Mean yy;
  Mean x;
  Mean y;
  Mean noise;
  for (int row = part.y; row < part.br().y; ++row) {
    const float* above = plane.row(row - 1);
    const float* here = plane.row(row);
    const float* below = plane.row(row + 1);
    float sum_xx = 0.0F;
    float sum_yy = 0.0F;
    float sum_x = 0.0F;
    float sum_y = 0.0F;
    float sum_noise = 0.0F;
    float count = 0.0F;
#pragma omp simd reduction(+ : sum_xx, sum_yy, sum_x, sum_y, sum_noise, count)
    for (int i = part.x; i < part.br().x; ++i) {
      const float beside = here[i - 1] + here[i + 1];
      const float over = above[i] + below[i];
      const float corners = above[i - 1] + above[i + 1] + below[i - 1] + below[i + 1];
      const float cxx = beside - 2.0F * here[i];
      const float cyy = over - 2.0F * here[i];
      const float gx = gradient_along(above, here, below, i);
      const float gy = gradient_across(above, below, i);
      const float checkered = corners - 2.0F * (beside + over) + 4.0F * here[i];
      const bool counts = checkered == checkered;
      sum_xx += counts ? cxx * cxx : 0.0F;
      sum_yy += counts ? cyy * cyy : 0.0F;
      sum_x += counts ? gx * gx : 0.0F;
      sum_y += counts ? gy * gy : 0.0F;
      sum_noise += counts ? checkered * checkered : 0.0F;
      count += counts ? 1.0F : 0.0F;
    }
    xx.add(sum_xx, count);
    yy.add(sum_yy, count);
    x.add(sum_x, count);
    y.add(sum_y, count);
    noise.add(sum_noise, count);
  }
  return {{xx.value(), yy.value()}, {x.value(), y.value()}, noise.value() / kImmerkaerNoise};
}

/// The energy of the gradient alone, as above.
DetailEnergy gradient_energy(const Plane& plane, const cv::Rect& part) {
  Mean along_x;
  Mean along_y;
  for (int y = part.y; y < part.br().y; ++y) {
    const float* above = plane.row(y - 1);
    const float* here = plane.row(y);
    const float* below = plane.row(y + 1);
    float row_x = 0.0F;
    float row_y = 0.0F;
    float count = 0.0F;
#pragma omp simd reduction(+ : row_x, row_y, count)
    for (int x = part.x; x < part.br().x; ++x) {
      const float gx = gradient_along(above, here, below, x);
      const float gy = gradient_across(above, below, x);
      const float both = gx + gy;
      const bool counts = both == both;
      row_x += counts ? gx * gx : 0.0F;
      row_y += counts ? gy * gy : 0.0F;
      count += counts ? 1.0F : 0.0F;
    }
    along_x.add(row_x, count);
    along_y.add(row_y, count);
  }
  return {along_x.value(), along_y.value()};
}

DetailEnergy less(DetailEnergy energy, double noise) {
  return {energy.along_x - noise, energy.along_y - noise};
}

/// Measures one tile after the other; what it needs of memory it keeps.
class TileMeasurer {
 public:
  TileMeasurer(const cv::Mat& image, const ClippingLevels& levels)
      : image_(image), levels_(levels) {}

  TileMeasures measure(const cv::Rect& tile) {
    const cv::Rect seen = cv::Rect(tile.x - kReach, tile.y - kReach, tile.width + 2 * kReach,
                                   tile.height + 2 * kReach) &
                          cv::Rect(0, 0, image_.cols, image_.rows);
    Colours colours;
    if (image_.depth() == CV_16U) {
      look<std::uint16_t>(seen, tile, colours);
    } else {
      look<std::uint8_t>(seen, tile, colours);
    }
    halve(fine_, middle_);
    halve(middle_, coarse_);

    TileMeasures measures;
    for (std::size_t c = 0; c < 3; ++c) measures.mean[c] = colours.means[c].value();
    measures.clipped = colours.clipped / static_cast<double>(tile.area());
    const FullResolution close = look_closely(fine_, part(fine_, seen, tile, 1));
    const double variance = close.noise_variance;
    measures.noise = std::sqrt(variance);
    measures.curvature = less(close.curvature, kCurvatureNoise * variance);
    measures.fine = less(close.gradient, kSobelNoise * variance);
    measures.middle =
        less(gradient_energy(middle_, part(middle_, seen, tile, 2)), kSobelNoise * variance / 4.0);
    measures.coarse =
        less(gradient_energy(coarse_, part(coarse_, seen, tile, 4)), kSobelNoise * variance / 16.0);
    return measures;
  }

 private:
  template <typename Sample>
  void look(const cv::Rect& seen, const cv::Rect& tile, Colours& colours) {
    fine_.resize(seen.width, seen.height);
    for (int y = 0; y < seen.height; ++y) {
      const Sample* pixels = image_.ptr<Sample>(seen.y + y) + 3L * seen.x;
      brightness_of_row(pixels, seen.width, levels_, fine_.row(y));
      if (seen.y + y < tile.y || seen.y + y >= tile.br().y) continue;
      const int skipped = tile.x - seen.x;
      add_colours(pixels + 3L * skipped, fine_.row(y) + skipped, tile.width, colours);
    }
  }

  /// The tile in a plane of what was seen at `scale`, less a pixel where the plane ends.
  static cv::Rect part(const Plane& plane, const cv::Rect& seen, const cv::Rect& tile, int scale) {
    const cv::Rect inside((tile.x - seen.x) / scale, (tile.y - seen.y) / scale, tile.width / scale,
                          tile.height / scale);
    return inside & cv::Rect(1, 1, plane.width - 2, plane.height - 2);
  }

  const cv::Mat& image_;
  const ClippingLevels& levels_;
  Plane fine_;
  Plane middle_;
  Plane coarse_;
};

}  // namespace

double TileMeasures::signal_to_noise() const {
  constexpr double kLeast = 1e-12;  // of a picture without any noise
  return fine.sum() / std::max(2.0 * kSobelNoise * noise * noise, kLeast);
}

FrameMeasures measure_frame(const cv::Mat& image) {
  FrameMeasures measures{TileGrid::of(image.size()), {}, clipping_levels(image)};
  measures.tiles.resize(static_cast<std::size_t>(measures.grid.count()));
  cv::parallel_for_({0, measures.grid.count()}, [&](const cv::Range& tiles) {
    TileMeasurer measurer(image, measures.clipping);
    for (int number = tiles.start; number < tiles.end; ++number) {
      measures.tiles[static_cast<std::size_t>(number)] =
          measurer.measure(measures.grid.tile(number));
    }
  });
  return measures;
}

}  // namespace biotomy::acquisition
