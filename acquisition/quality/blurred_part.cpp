#include "acquisition/quality/blurred_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/quality/tile_comparison.hpp"
#include "acquisition/quality/weighted_median.hpp"

namespace biotomy::acquisition {
namespace {

constexpr double kBlurred = 0.75;
constexpr double kCertain = 3.0;  // standard deviations
constexpr int kLeastTiles = 4;
constexpr int kLeastPixels = 400;  // of a tile: in fewer the content scatters more than blur does
constexpr int kReach = 1;          // tiles on each side that are asked together

/// How a tile's sharpness differs from the references', as a logarithm, and its inverse variance.
struct TileChange {
  double change = 0.0;
  double certainty = 0.0;  ///< 0 when the tile shows something else, or nothing but noise
};

TileChange change_of_tile(const FrameMeasures& frame, References references, std::size_t number) {
  const TileMeasures& tile = frame.tiles[number];
  const double alike = likeness_of_colours(tile, references, number);
  if (alike < kLeastLikeness) return {};
  const int pixels = frame.grid.tile(static_cast<int>(number)).area();
  double sum = 0.0;
  double weights = 0.0;
  for (const BandPair& pair : kBandPairs) {
    const double certain = certainty(references, number, pair, pixels);
    const auto found = change_of_quotient(tile, references, number, pair, &both_axes);
    if (certain <= 0.0 || !found) continue;
    sum += certain * pair.effect * *found;
    weights += certain * pair.effect * pair.effect;
  }
  return weights > 0.0 ? TileChange{sum / weights, alike * weights} : TileChange{};
}

/// Of a tile and those around it, in the weighted median: alone a tile's content may have changed.
bool is_blurred(const std::vector<TileChange>& tiles, const TileGrid& grid, int column, int row) {
  std::vector<Weighted> around;
  double certainty = 0.0;
  for (int y = std::max(row - kReach, 0); y <= std::min(row + kReach, grid.rows - 1); ++y) {
    for (int x = std::max(column - kReach, 0); x <= std::min(column + kReach, grid.columns - 1);
         ++x) {
      const TileChange& tile = tiles[static_cast<std::size_t>(y * grid.columns + x)];
      if (tile.certainty <= 0.0) continue;
      around.push_back({tile.change, tile.certainty});
      certainty += tile.certainty;
    }
  }
  if (around.empty()) return false;
  const double middle = weighted_median(std::move(around));
  return middle < std::log(kBlurred) && middle < -kCertain * kMedianOfMean / std::sqrt(certainty);
}

int largest_group(const cv::Mat& mask) {
  cv::Mat labels;
  cv::Mat statistics;
  cv::Mat centroids;
  const int groups = cv::connectedComponentsWithStats(mask, labels, statistics, centroids, 4);
  int largest = 0;
  for (int i = 1; i < groups; ++i) {  // 0 is all that is none
    largest = std::max(largest, statistics.at<int>(i, cv::CC_STAT_AREA));
  }
  return largest;
}

}  // namespace

std::optional<double> blurred_part(const FrameMeasures& frame, References references) {
  if (!comparable(frame, references) || frame.grid.tile(0).area() < kLeastPixels) {
    return std::nullopt;
  }
  std::vector<TileChange> tiles;
  for (std::size_t i = 0; i < frame.tiles.size(); ++i) {
    tiles.push_back(change_of_tile(frame, references, i));
  }
  const auto compared =
      std::ranges::count_if(tiles, [](const TileChange& tile) { return tile.certainty > 0.0; });
  if (compared < kLeastTiles) return std::nullopt;
  cv::Mat blurred(frame.grid.rows, frame.grid.columns, CV_8UC1);
  for (int row = 0; row < blurred.rows; ++row) {
    for (int column = 0; column < blurred.cols; ++column) {
      blurred.at<std::uint8_t>(row, column) = is_blurred(tiles, frame.grid, column, row) ? 255 : 0;
    }
  }
  return largest_group(blurred) / static_cast<double>(frame.grid.count());
}

}  // namespace biotomy::acquisition
