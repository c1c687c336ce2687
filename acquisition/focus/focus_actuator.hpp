#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "firmware_bridge/micrometres.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// What brings the face into focus: the column that carries the camera, or the camera's lens.
///
/// A position is that of the plane in focus, in micrometres, growing with the depth of the face: it
/// follows the face by as much as the face moves away, whatever moves. One motion at a time.
class FocusActuator {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  virtual ~FocusActuator() = default;

  /// "column" or "lens".
  virtual const char* name() const = 0;

  /// Where the plane can be brought.
  virtual bridge::AxisLimits limits() const = 0;

  /// Begins a motion to a position within the limits. Throws StepFailure, and what a device throws.
  virtual void move_to(bridge::Micrometres target, TimePoint now) = 0;

  /// True once it stands at its target. Throws like `move_to`, also when it stands elsewhere.
  virtual bool settled(const bridge::StageStatus& status, TimePoint now) = 0;

  /// Where it stands as the device reports it; nothing from a device that does not.
  virtual std::optional<bridge::Micrometres> reported(const bridge::StageStatus& status) const = 0;

  /// A position in the actuator's own unit, for people: "612.5 µm", "4.08 dioptres".
  virtual std::string describe(bridge::Micrometres position) const = 0;
};

}  // namespace biotomy::acquisition
