#pragma once

#include <optional>

#include "firmware_bridge/lines/gpio_line.hpp"
#include "firmware_bridge/lines/lines.hpp"

namespace biotomy::bridge {

/// An active input means the e-stop is pressed, the door open; an active output means on. Wire the
/// inputs so that a broken wire is active: a contact that opens on danger, to ground, with pull_up.
struct GpiodLinesSettings {
  GpioLineSettings estop;
  GpioLineSettings door;
  GpioLineSettings lamp;
  std::optional<GpioLineSettings> trigger;      ///< none: setting it is `configuration`
  std::optional<GpioLineSettings> tower_light;  ///< none: likewise
};

/// The rig's lines on GPIO chips of this computer, by libgpiod (version 1 or 2, as the system has
/// it). The constructor requests every line, with the outputs off, and throws DeviceError
/// (configuration) for a chip or line that is not there or is in use. An input that can't be read
/// is reported unsafe. Outputs go to off when it is destroyed.
class GpiodLines final : public Lines {
 public:
  explicit GpiodLines(const GpiodLinesSettings& settings);
  ~GpiodLines() override;

  SafetyInputs read_inputs() override;
  void set(OutputRole role, bool on) override;

 private:
  GpioLine& output(OutputRole role);

  GpioLine estop_;
  GpioLine door_;
  GpioLine lamp_;
  std::optional<GpioLine> trigger_;
  std::optional<GpioLine> tower_light_;
};

}  // namespace biotomy::bridge
