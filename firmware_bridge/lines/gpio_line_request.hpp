#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "firmware_bridge/lines/gpio_chips.hpp"
#include "firmware_bridge/lines/gpio_line_settings.hpp"

namespace biotomy::bridge {

/// Requests the line that the settings mean, again if it was lost. The chip is looked for by its
/// path, its name and its label, in this order; the line by its name, then by its offset.
///
/// What cannot be had throws DeviceError (configuration), which says what is wrong and what there
/// is instead: no such chip or line, more than one, not ours to open, held by whom, a bias or edges
/// that cannot be had. After the first success another chip under the same name is refused, too, as
/// far as its label tells: chips that are plugged in anew may change their numbers.
class GpioLineRequest {
 public:
  /// `chips` must outlive it.
  GpioLineRequest(GpioChips& chips, GpioLineSettings settings)
      : chips_(&chips), settings_(std::move(settings)) {}

  std::unique_ptr<GpioInput> input();
  std::unique_ptr<GpioOutput> output();

 private:
  template <class Ask>
  auto request(bool edges, Ask ask);

  GpioChips* chips_;
  GpioLineSettings settings_;
  std::optional<std::string> label_;  ///< of the chip that had the line
};

}  // namespace biotomy::bridge
