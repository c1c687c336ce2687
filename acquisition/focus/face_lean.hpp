#pragma once

#include "acquisition/focus/focus_map.hpp"
#include "firmware_bridge/micrometres.hpp"

namespace biotomy::acquisition {

/// How the face leans against the plane in focus, as far as its focus tells.
struct FaceLean {
  bridge::Micrometres across{};  ///< so much deeper at the right edge of the frame than at the left
  bridge::Micrometres down{};    ///< at the lower edge than at the upper
  double angle_degrees = 0.0;
  int tiles = 0;  ///< that it was told by
};

/// `width` and `height` are those of the frame on the face.
FaceLean lean_of(const FocusMap& map, bridge::Micrometres width, bridge::Micrometres height);

}  // namespace biotomy::acquisition
