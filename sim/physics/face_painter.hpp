#pragma once

#include <array>
#include <cstdint>

#include <opencv2/core/mat.hpp>

#include "sim/phantom/phantom.hpp"
#include "sim/physics/block.hpp"

namespace biotomy::sim {

/// The view of the camera: pixel (i, j) looks at x = i · pixel_um, y = j · pixel_um of the sample.
struct View {
  int width = 1000;
  int height = 1000;
  double pixel_um = 10;
};

/// How far the block sits from where it should, as the camera sees it.
struct Displacement {
  double x_um = 0;  ///< to the right
  double y_um = 0;  ///< down

  friend bool operator==(const Displacement&, const Displacement&) = default;
};

/// Draws the face of the block, sharp and evenly lit: what an ideal camera would see. The last
/// picture is kept, so that a focus sweep over one face draws it once. One thread at a time.
class FacePainter {
 public:
  /// `first_face_um` is the feed position at which z = 0 of the phantom lies.
  FacePainter(const Phantom& phantom, const View& view, double first_face_um);

  /// CV_32FC3, R, G, B in levels 0..255. The picture belongs to the painter until the next call.
  const cv::Mat& paint(const Block& block, const Displacement& displacement = {});

 private:
  void paint_strips(const std::array<double, Block::kStrips>& depth_um,
                    const Displacement& displacement);
  void strew(const Block& block, const Displacement& displacement);

  const Phantom& phantom_;
  View view_;
  double first_face_um_;
  cv::Mat face_;     ///< ground surface alone
  cv::Mat picture_;  ///< with what lies on it
  std::array<double, Block::kStrips> painted_depth_um_{};
  Displacement painted_displacement_{};
  std::uint32_t painted_passes_ = 0;
  double painted_blown_ms_ = -1;
};

}  // namespace biotomy::sim
