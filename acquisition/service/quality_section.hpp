#pragma once

#include <string>

#include "acquisition/quality/assessment.hpp"
#include "acquisition/settings/ladder_settings.hpp"
#include "firmware_bridge/wire/checked_table.hpp"

namespace biotomy::acquisition {

/// [quality] of rig.toml: what a frame must be, and what is tried when it is not.
void read_quality(const bridge::CheckedTable& table, QualityThresholds& thresholds,
                  LadderSettings& ladder);

/// What "pause" and "accept" mean, the names that the policy has in files and options.
LadderSettings::Exhausted exhausted_policy(const std::string& name);

}  // namespace biotomy::acquisition
