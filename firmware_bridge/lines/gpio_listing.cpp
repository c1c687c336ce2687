#include "firmware_bridge/lines/gpio_listing.hpp"

#include <system_error>

#include "firmware_bridge/device_access.hpp"

namespace biotomy::bridge {

std::vector<ListedGpioChip> list_gpio_chips(GpioChips& chips) {
  std::vector<ListedGpioChip> listed;
  for (const std::filesystem::path& device : chips.devices()) {
    try {
      listed.push_back({.chip = chips.describe(device), .trouble = {}});
    } catch (const std::system_error& error) {
      listed.push_back(
          {.chip = {.device = device, .name = device.filename(), .label = {}, .lines = {}},
           .trouble =
               access_complaint(device).value_or("it does not answer: " + error.code().message())});
    }
  }
  return listed;
}

}  // namespace biotomy::bridge
