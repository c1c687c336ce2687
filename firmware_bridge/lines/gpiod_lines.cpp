#include "firmware_bridge/lines/gpiod_lines.hpp"

#include "firmware_bridge/device_error.hpp"

namespace biotomy::bridge {

namespace {

std::optional<GpioLine> optional_output(const std::optional<GpioLineSettings>& settings) {
  if (!settings) return std::nullopt;
  return GpioLine::output(*settings);
}

/// A line that can't be read is reported in its unsafe state, which is "active".
bool active_or_unreadable(GpioLine& line, std::string& failure) {
  try {
    return line.is_active();
  } catch (const DeviceError& error) {
    failure = error.what();
    return true;
  }
}

void switch_off(GpioLine& line) {
  try {
    line.set_active(false);
  } catch (const DeviceError&) {
    // The chip is gone: there is nothing left to switch, and nobody to tell in a destructor.
  }
}

}  // namespace

GpiodLines::GpiodLines(const GpiodLinesSettings& settings)
    : estop_(GpioLine::input(settings.estop)),
      door_(GpioLine::input(settings.door)),
      lamp_(GpioLine::output(settings.lamp)),
      trigger_(optional_output(settings.trigger)),
      tower_light_(optional_output(settings.tower_light)) {}

GpiodLines::~GpiodLines() {
  switch_off(lamp_);
  if (trigger_) switch_off(*trigger_);
  if (tower_light_) switch_off(*tower_light_);
}

SafetyInputs GpiodLines::read_inputs() {
  SafetyInputs inputs;
  inputs.estop_pressed = active_or_unreadable(estop_, inputs.failure);
  inputs.door_open = active_or_unreadable(door_, inputs.failure);
  return inputs;
}

GpioLine& GpiodLines::output(OutputRole role) {
  if (role == OutputRole::lamp) return lamp_;
  std::optional<GpioLine>& line = role == OutputRole::trigger ? trigger_ : tower_light_;
  if (!line) {
    throw DeviceError(DeviceError::Kind::configuration, std::string("lines: no line is set for ") +
                                                            to_string(role) +
                                                            "; name one in the configuration");
  }
  return *line;
}

void GpiodLines::set(OutputRole role, bool on) {
  output(role).set_active(on);
}

}  // namespace biotomy::bridge
