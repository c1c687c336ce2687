#pragma once

#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// Whether the wheel stands.
bool wheel_stands(const bridge::StageStatus& status, const SafetyLimits& limits);

/// Whether it clearly does not, where it must.
bool wheel_turns(const bridge::StageStatus& status, const SafetyLimits& limits);

/// Throws StepFailure when the axis is not where it should be.
void check_position(const char* axis, bridge::Micrometres actual, bridge::Micrometres expected,
                    const SafetyLimits& limits);

}  // namespace biotomy::acquisition
