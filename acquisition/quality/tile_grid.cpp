#include "acquisition/quality/tile_grid.hpp"

#include <algorithm>
#include <cmath>

namespace biotomy::acquisition {
namespace {

constexpr double kTiles = 96.0;
constexpr int kLeastSide = 16;  // smaller tiles hold too little detail to measure

int part(int whole, int number, int parts) {
  return static_cast<int>(static_cast<long>(whole) * number / parts);
}

}  // namespace

TileGrid TileGrid::of(cv::Size frame) {
  if (frame.empty()) return {};
  const double side = std::max<double>(
      std::sqrt(static_cast<double>(frame.width) * frame.height / kTiles), kLeastSide);
  const auto parts = [side](int length) {
    return std::max(1, static_cast<int>(std::lround(length / side)));
  };
  return {parts(frame.width), parts(frame.height), frame};
}

cv::Rect TileGrid::tile(int number) const {
  const int column = number % columns;
  const int row = number / columns;
  const int left = part(frame.width, column, columns);
  const int top = part(frame.height, row, rows);
  return {left, top, part(frame.width, column + 1, columns) - left,
          part(frame.height, row + 1, rows) - top};
}

}  // namespace biotomy::acquisition
