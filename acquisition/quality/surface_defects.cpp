#include "acquisition/quality/surface_defects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/quality/shade.hpp"
#include "acquisition/quality/surface_colours.hpp"
#include "acquisition/quality/thumbnail.hpp"

namespace biotomy::acquisition {
namespace {

constexpr int kNearby = 5;      ///< cells along the side of the square in which edges may move
constexpr int kOutside = 6;     ///< steps of the surface scale beyond all that is nearby
constexpr double kFull = 0.97;  ///< of full scale
constexpr int kGlarePixels = kCell * kCell / 16;
constexpr float kVeil = 0.07F;    ///< opacity
constexpr float kHides = 0.65F;   ///< opacity: beyond, it is another material
constexpr float kUniform = 0.3F;  ///< the colours' opacities differ at most by this part
constexpr float kUnsure = 0.03F;  ///< and by so much anyway
constexpr float kBright = 0.75F;  ///< of full scale: a veil makes it hardly brighter
constexpr int kVeilMedian = 5;
constexpr double kLargestSpeck = 0.008;  ///< of the frame
constexpr int kLeastLargest = 40;        ///< cells

/// The factor of the light at each cell of the light grid.
cv::Mat light_factor(const LightChange& light, cv::Size size) {
  cv::Mat factor(size, CV_32FC3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double u = (2.0 * x + 1.0) / size.width - 1.0;
      const double v = (2.0 * y + 1.0) / size.height - 1.0;
      auto& cell = factor.at<cv::Vec3f>(y, x);
      for (int c = 0; c < 3; ++c) {
        cell[c] =
            static_cast<float>(std::exp(light.colours.at(static_cast<std::size_t>(c)).at(u, v)));
      }
    }
  }
  return factor;
}

cv::Mat without_light(const cv::Mat& cells, const cv::Mat& factor) {
  cv::Mat wide;
  cv::resize(factor, wide, cells.size(), 0.0, 0.0, cv::INTER_LINEAR);
  return cells / wide;
}

/// 255 where a colour of a cell is outside all that it was nearby. In surface scale.
cv::Mat outside_of_nearby(const cv::Mat& now, const cv::Mat& before) {
  const cv::Mat square = cv::Mat::ones(kNearby, kNearby, CV_8U);
  cv::Mat most;
  cv::Mat least;
  cv::dilate(before, most, square);
  cv::erode(before, least, square);
  cv::Mat outside(now.size(), CV_8UC1);
  cv::parallel_for_({0, now.rows}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      const auto* cell = now.ptr<cv::Vec3b>(y);
      const auto* upper = most.ptr<cv::Vec3b>(y);
      const auto* lower = least.ptr<cv::Vec3b>(y);
      auto* out = outside.ptr<std::uint8_t>(y);
      for (int x = 0; x < now.cols; ++x) {
        int beyond = 0;
        for (int c = 0; c < 3; ++c) {
          beyond = std::max({beyond, cell[x][c] - upper[x][c], lower[x][c] - cell[x][c]});
        }
        out[x] = beyond > kOutside ? 255 : 0;
      }
    }
  });
  return outside;
}

/// The opacity of a white veil that would make `now` of `before`; 0 where none would, and where it
/// could hardly be seen.
float veil_over(const cv::Vec3f& now, const cv::Vec3f& before) {
  float least = 1.0F;
  float most = -1.0F;
  int colours = 0;
  for (int c = 0; c < 3; ++c) {
    if (before[c] > kBright) continue;
    const float opacity = (now[c] - before[c]) / (1.0F - before[c]);
    least = std::min(least, opacity);
    most = std::max(most, opacity);
    ++colours;
  }
  const bool is_veil =
      colours >= 2 && most <= kHides && most - least <= std::max(kUnsure, kUniform * most);
  return is_veil ? least : 0.0F;
}

/// Without what is connected over more than a speck of debris.
cv::Mat specks_of(const cv::Mat& mask) {
  const int largest =
      std::max(kLeastLargest, static_cast<int>(kLargestSpeck * static_cast<double>(mask.total())));
  cv::Mat labels;
  cv::Mat statistics;
  cv::Mat centroids;
  cv::connectedComponentsWithStats(mask, labels, statistics, centroids, 4);
  cv::Mat specks = mask.clone();
  for (int y = 0; y < mask.rows; ++y) {
    const auto* label = labels.ptr<int>(y);
    auto* speck = specks.ptr<std::uint8_t>(y);
    for (int x = 0; x < mask.cols; ++x) {
      if (statistics.at<int>(label[x], cv::CC_STAT_AREA) > largest) speck[x] = 0;
    }
  }
  return specks;
}

/// 255 where there is a veil, over the light grid.
cv::Mat veiled(const cv::Mat& now, const cv::Mat& before) {
  cv::Mat opacity(now.size(), CV_32FC1);
  for (int y = 0; y < now.rows; ++y) {
    const auto* a = now.ptr<cv::Vec3f>(y);
    const auto* b = before.ptr<cv::Vec3f>(y);
    for (int x = 0; x < now.cols; ++x) {
      opacity.at<float>(y, x) = veil_over(a[x], b[x]);
    }
  }
  cv::Mat usual;
  cv::medianBlur(opacity, usual, kVeilMedian);
  return usual > kVeil;
}

/// 255 where there is casting material, over the thumbnail.
cv::Mat casting_in(const SurfacePrint& surface, const SurfaceRecord& record) {
  if (!record.casting()) return cv::Mat::zeros(surface.thumbnail.size(), CV_8UC1);
  return casting_cells(surface.thumbnail, *record.casting());
}

template <typename Sample>
bool glares(const cv::Mat& image, const ClippingLevels& levels, int cell_x, int cell_y) {
  constexpr auto kNearlyFull = static_cast<int>(kFull * std::numeric_limits<Sample>::max());
  const std::array least{std::min(levels[0], kNearlyFull), std::min(levels[1], kNearlyFull),
                         std::min(levels[2], kNearlyFull)};
  int full = 0;
  for (int y = 0; y < kCell; ++y) {
    const Sample* pixel = image.ptr<Sample>(cell_y * kCell + y) + 3 * kCell * cell_x;
    for (int x = 0; x < kCell; ++x, pixel += 3) {
      if (pixel[0] >= least[0] && pixel[1] >= least[1] && pixel[2] >= least[2]) ++full;
    }
  }
  return full >= kGlarePixels;
}

bool glares(const cv::Mat& image, const ClippingLevels& levels, int cell_x, int cell_y) {
  return image.depth() == CV_16U ? glares<std::uint16_t>(image, levels, cell_x, cell_y)
                                 : glares<std::uint8_t>(image, levels, cell_x, cell_y);
}

}  // namespace

SurfaceDefects find_surface_defects(const cv::Mat& image, const ClippingLevels& clipping,
                                    const SurfacePrint& now, const SurfaceRecord& record,
                                    const LightChange& light) {
  const SurfacePrint& before = *record.surface();
  const cv::Mat factor = light_factor(light, now.light.size());
  const cv::Mat cells = surface_scale(without_light(now.thumbnail, factor));
  const cv::Mat outside = outside_of_nearby(cells, surface_scale(before.thumbnail));
  const cv::Mat unknown = KnownColours(record.colours()).unknown_in(cells);
  const cv::Mat in_light_of_before = now.light / factor;
  const cv::Mat frost = veiled(in_light_of_before, before.light);
  const cv::Mat shade = shaded(in_light_of_before, before.light);
  const cv::Mat specks = specks_of(outside);
  cv::Mat frosted;
  cv::resize(frost, frosted, cells.size(), 0.0, 0.0, cv::INTER_NEAREST);

  int debris = 0;
  int glare = 0;
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.cols; ++x) {
      if (outside.at<std::uint8_t>(y, x) == 0 || unknown.at<std::uint8_t>(y, x) == 0) continue;
      if (glares(image, clipping, x, y)) {
        ++glare;
      } else if (frosted.at<std::uint8_t>(y, x) == 0 && specks.at<std::uint8_t>(y, x) != 0) {
        ++debris;
      }
    }
  }
  const auto all = static_cast<double>(cells.total());
  return {.debris = debris / all,
          .frost = cv::countNonZero(frost) / static_cast<double>(frost.total()),
          .glare = glare / all,
          .shade = cv::countNonZero(shade) / static_cast<double>(shade.total()),
          .arrived = cv::countNonZero(outside & ~specks & ~casting_in(now, record)) / all};
}

}  // namespace biotomy::acquisition
