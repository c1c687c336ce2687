#pragma once

#include <chrono>

#include "firmware_bridge/micrometres.hpp"

namespace biotomy::acquisition {

/// Positions are those of the plane in focus, growing away from the camera's side as the face does:
/// with the column its own position, with a lens the distance of the plane from the lens.
struct FocusSettings {
  enum class Actuator { column, lens } actuator = Actuator::column;
  bridge::Micrometres start{};               ///< where the first search of a sample begins
  bridge::Micrometres depth_of_field{40.0};  ///< see depth_of_field()
  bridge::Micrometres step{20.0};            ///< between the points of the finest bracket
  int points = 5;                            ///< of a bracket
  int shifts = 8;                            ///< brackets after the first, in one search
  bridge::Micrometres reach{1000.0};         ///< no search leaves the predicted position by more
  bridge::Micrometres largest_change{40.0};  ///< of the focus against what was predicted, a layer
  bridge::Micrometres backlash{50.0};        ///< every position is approached from below by so much
  std::chrono::milliseconds time_limit{300000};  ///< of one search
  int every_layers = 10;                         ///< a search at the latest after so many layers
  double search_below_ratio = 0.95;  ///< and when the sharpness fell below this part of the peak
};

}  // namespace biotomy::acquisition
