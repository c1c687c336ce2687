#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "acquisition/focus/face_lean.hpp"
#include "firmware_bridge/micrometres.hpp"

namespace biotomy::acquisition {

/// What the last search for the focus came to.
struct FocusReport {
  std::int64_t layer = 0;
  std::string why;  ///< it was searched
  bool found = false;
  std::string why_not;   ///< empty when it was found
  std::string actuator;  ///< "column" or "lens"
  std::string position;  ///< in the actuator's unit
  bridge::Micrometres plane{};
  int frames = 0;  ///< that it took
  std::optional<FaceLean> lean;
};

}  // namespace biotomy::acquisition
