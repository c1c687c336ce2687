#pragma once

#include <opencv2/core/types.hpp>

namespace biotomy::acquisition {

/// How a frame is divided for assessment: tiles of nearly one size, some 96 of them and about
/// square, numbered row by row. The same for every frame of a size.
struct TileGrid {
  int columns = 0;
  int rows = 0;
  cv::Size frame;

  static TileGrid of(cv::Size frame);

  int count() const { return columns * rows; }

  /// Pixels of the frame; the tiles cover it without gap or overlap.
  cv::Rect tile(int number) const;

  friend bool operator==(const TileGrid&, const TileGrid&) = default;
};

}  // namespace biotomy::acquisition
