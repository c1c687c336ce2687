#pragma once

#include "acquisition/job/quality_ladder.hpp"
#include "acquisition/quality/assessment.hpp"
#include "firmware_bridge/wire/checked_table.hpp"

namespace biotomy::acquisition {

/// [quality] of rig.toml: what a frame must be, and what is tried when it is not.
void read_quality(const bridge::CheckedTable& table, QualityThresholds& thresholds,
                  LadderSettings& ladder);

}  // namespace biotomy::acquisition
