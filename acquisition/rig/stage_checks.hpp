#pragma once

#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Whether the wheel stands.
bool wheel_stands(const bridge::StageStatus& status, const SafetyLimits& limits);

/// At more than this it clearly does not, where it must.
double turning_rpm(const SafetyLimits& limits);
bool wheel_turns(const bridge::StageStatus& status, const SafetyLimits& limits);

/// Throws StepFailure when the axis is not where it should be.
void check_position(const char* axis, bridge::Micrometres actual, bridge::Micrometres expected,
                    const SafetyLimits& limits);

}  // namespace biotomy::acquisition
