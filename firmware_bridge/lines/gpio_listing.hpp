#pragma once

#include <string>
#include <vector>

#include "firmware_bridge/lines/gpio_chips.hpp"

namespace biotomy::bridge {

struct ListedGpioChip {
  GpioChipInfo chip;    ///< without label and lines when it could not be asked
  std::string trouble;  ///< why it could not be, in words; empty when it could
};

/// The GPIO chips there are, by their numbers. No line is requested.
std::vector<ListedGpioChip> list_gpio_chips(GpioChips& chips);

}  // namespace biotomy::bridge
