#include "acquisition/rig/stage_checks.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "acquisition/rig/step_failure.hpp"

namespace biotomy::acquisition {

bool wheel_stands(const bridge::StageStatus& status, const SafetyLimits& limits) {
  return std::abs(status.spindle_rpm) <= limits.wheel_stands_rpm;
}

double turning_rpm(const SafetyLimits& limits) {
  constexpr double kClearly = 3.0;
  return kClearly * limits.wheel_stands_rpm;
}

bool wheel_turns(const bridge::StageStatus& status, const SafetyLimits& limits) {
  return std::abs(status.spindle_rpm) > turning_rpm(limits);
}

void check_position(const char* axis, bridge::Micrometres actual, bridge::Micrometres expected,
                    const SafetyLimits& limits) {
  if (std::abs((actual - expected).value) <= limits.position_tolerance.value) return;
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "the %s is at %.1f µm and should be at %.1f µm: look for what holds it", axis,
                actual.value, expected.value);
  throw StepFailure(text.data(), AlarmKind::motion);
}

}  // namespace biotomy::acquisition
