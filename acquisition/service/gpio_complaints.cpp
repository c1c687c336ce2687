#include "acquisition/service/gpio_complaints.hpp"

#include <memory>
#include <string>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/lines/gpio_line_request.hpp"

namespace biotomy::acquisition {

Complaints gpio_complaints(const bridge::GpiodLinesSettings& settings, bridge::GpioChips& chips) {
  Complaints complaints;
  // Held until the end: the same line for two roles is refused the second time.
  std::vector<std::unique_ptr<bridge::GpioInput>> inputs;
  std::vector<std::unique_ptr<bridge::GpioOutput>> outputs;
  const auto attempt = [&](const char* role, auto request) {
    try {
      request();
    } catch (const bridge::DeviceError& error) {
      complaints.push_back(std::string("lines.") + role + ": " + error.what());
    }
  };
  const auto input = [&](const char* role, const bridge::GpioLineSettings& line) {
    attempt(role, [&] { inputs.push_back(bridge::GpioLineRequest(chips, line).input()); });
  };
  const auto output = [&](bridge::OutputRole role, const bridge::GpioLineSettings& line) {
    attempt(to_string(role),
            [&] { outputs.push_back(bridge::GpioLineRequest(chips, line).output()); });
  };
  input("estop", settings.estop);
  input("door", settings.door);
  output(bridge::OutputRole::lamp, settings.lamp);
  if (settings.trigger) output(bridge::OutputRole::trigger, *settings.trigger);
  if (settings.tower_light) output(bridge::OutputRole::tower_light, *settings.tower_light);
  return complaints;
}

}  // namespace biotomy::acquisition
