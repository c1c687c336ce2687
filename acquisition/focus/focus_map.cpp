#include "acquisition/focus/focus_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "acquisition/focus/detail.hpp"
#include "acquisition/focus/focus_curve.hpp"
#include "acquisition/quality/median.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kLeastTiles = 6;
constexpr double kFarthest = 2.0;     ///< a tile's peak beyond the bracket, in steps, is none
constexpr double kLeastError = 0.05;  ///< in steps: what a parabola leaves in spite of no noise
constexpr double kUsualTilt = 4.0;    ///< in steps: where the tiles tell nothing, it is none
constexpr double kBiweight = 4.685;   ///< standard deviations beyond which a tile has no say
constexpr int kRounds = 20;

/// All in steps of the bracket; x and y are parts of the frame, from its middle.
struct TilePeak {
  double x = 0.0;
  double y = 0.0;
  double peak = 0.0;
  double error = 0.0;
  double say = 1.0;  ///< what robustness leaves of its weight
};

struct Plane {
  cv::Vec3d parts;  ///< at the middle, across, down
  cv::Matx33d covariance;

  double at(const TilePeak& tile) const { return parts[0] + parts[1] * tile.x + parts[2] * tile.y; }
};

std::vector<TilePeak> peaks_of(std::span<const BracketFrame> bracket) {
  std::vector<std::vector<Detail>> details;
  for (const BracketFrame& frame : bracket) details.push_back(detail_of_tiles(*frame.measures));
  const TileGrid& grid = bracket.front().measures->grid;
  std::vector<TilePeak> peaks;
  for (const std::size_t number : telling_tiles(details)) {
    std::vector<Detail> along;
    along.reserve(details.size());
    for (const auto& frame : details) along.push_back(frame[number]);
    const std::optional<ParabolaFit> fit = fit_parabola(focus_curve(along));
    if (!fit) continue;
    const double last = static_cast<double>(bracket.size()) - 1.0;
    if (fit->vertex < -kFarthest || fit->vertex > last + kFarthest) continue;
    const cv::Rect tile = grid.tile(static_cast<int>(number));
    peaks.push_back({(tile.x + 0.5 * tile.width) / grid.frame.width - 0.5,
                     (tile.y + 0.5 * tile.height) / grid.frame.height - 0.5, fit->vertex,
                     std::hypot(fit->vertex_error, kLeastError)});
  }
  return peaks;
}

Plane fit_plane(const std::vector<TilePeak>& tiles) {
  cv::Matx33d normal = cv::Matx33d::zeros();
  normal(1, 1) = normal(2, 2) = 1.0 / (kUsualTilt * kUsualTilt);
  cv::Vec3d right;
  for (const TilePeak& tile : tiles) {
    const double weight = tile.say / (tile.error * tile.error);
    const cv::Vec3d row(1.0, tile.x, tile.y);
    normal += weight * (row * row.t());
    right += weight * tile.peak * row;
  }
  const cv::Matx33d covariance = normal.inv(cv::DECOMP_SVD);
  return {covariance * right, covariance};
}

/// How many of their own standard deviations the tiles lie away from the plane, typically; at least
/// one.
double scatter_about(const Plane& plane, const std::vector<TilePeak>& tiles) {
  std::vector<double> distances;
  distances.reserve(tiles.size());
  for (const TilePeak& tile : tiles) {
    distances.push_back(std::abs(tile.peak - plane.at(tile)) / tile.error);
  }
  constexpr double kOfANormal = 1.4826;
  return std::max(1.0, kOfANormal * median(std::move(distances)));
}

void weigh(const Plane& plane, double scatter, std::vector<TilePeak>& tiles) {
  for (TilePeak& tile : tiles) {
    const double away = (tile.peak - plane.at(tile)) / (kBiweight * scatter * tile.error);
    const double left = std::max(0.0, 1.0 - away * away);
    tile.say = left * left;
  }
}

/// The plane that half of the tiles lie nearest to, level at first: to begin with, no outlier may
/// pull it.
Plane level_plane(const std::vector<TilePeak>& tiles) {
  std::vector<double> peaks;
  peaks.reserve(tiles.size());
  for (const TilePeak& tile : tiles) peaks.push_back(tile.peak);
  return {{median(std::move(peaks)), 0.0, 0.0}, {}};
}

}  // namespace

bridge::Micrometres FocusMap::tilt() const {
  return {std::abs(across.value) + std::abs(down.value)};
}

std::optional<FocusMap> fit_focus_map(std::span<const BracketFrame> bracket) {
  std::vector<TilePeak> tiles = peaks_of(bracket);
  if (tiles.size() < kLeastTiles) return std::nullopt;
  Plane plane = level_plane(tiles);
  double scatter = scatter_about(plane, tiles);
  for (int round = 0; round < kRounds; ++round) {
    weigh(plane, scatter, tiles);
    plane = fit_plane(tiles);
    scatter = scatter_about(plane, tiles);
  }
  std::erase_if(tiles, [](const TilePeak& tile) { return tile.say <= 0.0; });
  if (tiles.size() < kLeastTiles) return std::nullopt;
  const auto by_height = [&](const TilePeak& tile) { return plane.at(tile); };
  const auto [nearest, farthest] = std::ranges::minmax_element(tiles, {}, by_height);
  const cv::Vec3d place(1.0, 0.5 * (nearest->x + farthest->x), 0.5 * (nearest->y + farthest->y));

  const bridge::Micrometres first = bracket.front().position;
  const bridge::Micrometres step =
      (1.0 / static_cast<double>(bracket.size() - 1)) * (bracket.back().position - first);
  FocusMap map;
  map.middle = first + plane.parts.dot(place) * step;
  map.middle_error = scatter * std::sqrt(place.dot(plane.covariance * place)) * step;
  map.across = plane.parts[1] * step;
  map.down = plane.parts[2] * step;
  map.tiles = static_cast<int>(tiles.size());
  return map;
}

}  // namespace biotomy::acquisition
