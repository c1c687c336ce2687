#pragma once

#include <memory>
#include <string>

#include "firmware_bridge/lines/gpio_chips.hpp"
#include "firmware_bridge/lines/gpio_line_settings.hpp"

namespace biotomy::bridge {

/// "line 17 of GPIO chip gpiochip0".
std::string name_of(const GpioLineSettings& settings);

/// The line that the settings mean, requested. The chip is looked for by its path, its name and its
/// label, in this order; the line by its name, then by its offset. Throws DeviceError
/// (configuration), which says what is wrong and what there is instead: no such chip or line, more
/// than one, not ours to open, held by whom, a bias or edges that cannot be had.
std::unique_ptr<GpioInput> request_input(GpioChips& chips, const GpioLineSettings& settings);
std::unique_ptr<GpioOutput> request_output(GpioChips& chips, const GpioLineSettings& settings);

}  // namespace biotomy::bridge
