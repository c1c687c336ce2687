#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "acquisition/rig/step_failure.hpp"
#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Watches that the axes do what they should: move while they are on their way, and stay where they
/// are while the controller is idle. It sees what no limit of a step sees in time: a motor that
/// stalls, a column that sinks, a spindle that does not start.
class MotionWatch {
 public:
  explicit MotionWatch(const SafetyLimits& limits);

  /// One reading of the controller.
  void observe(const bridge::StageStatus& status, TimePoint now);

  /// Forgets where the axes were: somebody may have moved them.
  void forget();

  /// What does not move as it should, in a sentence; nothing when all does.
  const std::optional<std::string>& cause() const { return cause_; }

 private:
  static constexpr std::size_t kAxes = 3;
  struct Axis {
    const char* name;
    bridge::Micrometres position;
    bridge::Micrometres target;
  };
  using Axes = std::array<Axis, kAxes>;
  /// Since when an axis is where it is, within the tolerance.
  struct Stay {
    bridge::Micrometres position;
    TimePoint since;
  };
  /// The machine when anything of it moved last, of a command under way.
  struct Stir {
    Axes axes;
    double spindle_rpm;
    TimePoint at;
  };

  static Axes axes_of(const bridge::StageStatus& status);
  std::optional<std::string> drifted(const Axes& axes);
  std::optional<std::string> stalled(const Axes& axes, TimePoint now);
  std::optional<std::string> standing_still(const bridge::StageStatus& status, TimePoint now);
  bool near(bridge::Micrometres a, bridge::Micrometres b) const;
  bool same_places(const Axes& a, const Axes& b) const;

  SafetyLimits limits_;
  std::optional<Axes> at_rest_;     ///< where the idle controller left them
  std::uint32_t last_command_ = 0;  ///< that was started, by the controller's echo
  std::optional<std::array<Stay, kAxes>> stays_;
  std::optional<Stir> stir_;
  std::optional<std::string> cause_;
};

}  // namespace biotomy::acquisition
