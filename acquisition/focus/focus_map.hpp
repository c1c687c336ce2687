#pragma once

#include <memory>
#include <optional>
#include <span>

#include "acquisition/quality/frame_measures.hpp"
#include "firmware_bridge/micrometres.hpp"

namespace biotomy::acquisition {

/// A frame of a bracket, by what was measured of it.
struct BracketFrame {
  bridge::Micrometres position{};
  std::shared_ptr<const FrameMeasures> measures;
};

/// Where each part of the face would be sharpest: a plane through the tiles' own peaks.
struct FocusMap {
  /// Half-way between the nearest and the farthest tile that shows detail.
  bridge::Micrometres middle{};
  bridge::Micrometres middle_error{};  ///< standard deviation, by the scatter of the tiles
  bridge::Micrometres across{};        ///< so much farther at the right edge than at the left
  bridge::Micrometres down{};          ///< at the lower edge than at the upper
  int tiles = 0;                       ///< that the plane was fitted to

  /// Between the nearest corner of the frame and the farthest.
  bridge::Micrometres tilt() const;
};

/// Fits a parabola to each tile's logarithm of detail along the bracket, and a plane to the peaks,
/// robustly (iteratively reweighted least squares with the biweight of Beaton & Tukey,
/// Technometrics 16 (1974) 147): a chip that lies on the face, or frost that grows meanwhile, is
/// not the face. Nothing when fewer than six tiles show enough detail.
/// The bracket's frames are at equal distances in growing order.
std::optional<FocusMap> fit_focus_map(std::span<const BracketFrame> bracket);

}  // namespace biotomy::acquisition
