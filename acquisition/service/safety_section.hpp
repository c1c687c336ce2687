#pragma once

#include "acquisition/settings/safety_limits.hpp"
#include "firmware_bridge/wire/checked_table.hpp"

namespace biotomy::acquisition {

/// [safety] of rig.toml: what stops the rig, and how long anything may take.
SafetyLimits read_safety(const bridge::CheckedTable& table);

}  // namespace biotomy::acquisition
