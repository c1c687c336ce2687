#pragma once

#include "acquisition/job/preflight_complaints.hpp"
#include "firmware_bridge/lines/gpio_chips.hpp"
#include "firmware_bridge/lines/gpiod_lines.hpp"

namespace biotomy::acquisition {

/// Why lines that are wired to a role cannot be had, role by role; GpiodLines tells of the first
/// alone. Every line is requested as it does, and let go at the end.
Complaints gpio_complaints(const bridge::GpiodLinesSettings& settings, bridge::GpioChips& chips);

}  // namespace biotomy::acquisition
