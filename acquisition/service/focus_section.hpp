#pragma once

#include "acquisition/focus/focus_settings.hpp"
#include "firmware_bridge/micrometres.hpp"
#include "firmware_bridge/wire/checked_table.hpp"

namespace biotomy::acquisition {

/// [focus] of rig.toml: how the face is followed and its focus searched. `pixel` is the larger side
/// of a pixel on the face.
FocusSettings read_focus(const bridge::CheckedTable& table, bridge::Micrometres pixel);

}  // namespace biotomy::acquisition
