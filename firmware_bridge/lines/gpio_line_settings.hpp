#pragma once

#include <string>

namespace biotomy::bridge {

enum class LineBias { as_is, disabled, pull_up, pull_down };

struct GpioLineSettings {
  std::string chip;         ///< "gpiochip0", "/dev/gpiochip0" or the chip's label
  std::string line;         ///< the line's name, or its offset as a number
  bool active_low = false;  ///< a low voltage is "active"
  /// The line's own resistor. A kernel that cannot set it (before 5.5) refuses the line; a chip
  /// that has none is not found out: the kernel does not say.
  LineBias bias = LineBias::as_is;
  /// Of an input: see pulses between two looks, too. Needs a chip with interrupts.
  bool edges = true;
};

}  // namespace biotomy::bridge
