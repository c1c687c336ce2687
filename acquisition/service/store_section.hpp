#pragma once

#include "acquisition/settings/job_settings.hpp"
#include "firmware_bridge/wire/checked_table.hpp"

namespace biotomy::acquisition {

/// [store] of rig.toml: how layers and volume are written.
StorePlan read_store(const bridge::CheckedTable& table);

}  // namespace biotomy::acquisition
