#pragma once

#include <optional>
#include <string>

#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// What the stage says of itself; nothing when a line lost the question or the answer, which is no
/// reason to stop: ask again at the next tick. Throws DeviceError.
std::optional<bridge::StageIdentity> ask_identity(bridge::Stage& stage);

/// Why nothing may move by this stage: nobody would stop it soon if the daemon hung, or it would be
/// stopped although the daemon does not hang. Nothing when it may.
std::optional<std::string> watchdog_complaint(const SafetyLimits& limits,
                                              const bridge::StageIdentity& stage);

}  // namespace biotomy::acquisition
