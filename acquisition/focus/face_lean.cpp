#include "acquisition/focus/face_lean.hpp"

#include <cmath>
#include <numbers>

namespace biotomy::acquisition {

FaceLean lean_of(const FocusMap& map, bridge::Micrometres width, bridge::Micrometres height) {
  const double slope = std::hypot(map.across.value / width.value, map.down.value / height.value);
  return {map.across, map.down, std::atan(slope) * 180.0 / std::numbers::pi, map.tiles};
}

}  // namespace biotomy::acquisition
