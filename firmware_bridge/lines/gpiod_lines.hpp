#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "firmware_bridge/lines/gpio_chips.hpp"
#include "firmware_bridge/lines/gpio_line_settings.hpp"
#include "firmware_bridge/lines/input_debounce.hpp"
#include "firmware_bridge/lines/lines.hpp"
#include "firmware_bridge/lines/recovering_line.hpp"

namespace biotomy::bridge {

/// An active input means the e-stop is pressed, the door open; an active output means on. Wire the
/// inputs so that a broken wire is active: a contact that opens on danger, to ground, with pull_up.
struct GpiodLinesSettings {
  GpioLineSettings estop;
  GpioLineSettings door;
  GpioLineSettings lamp;
  std::optional<GpioLineSettings> trigger;      ///< none: setting it is `configuration`
  std::optional<GpioLineSettings> tower_light;  ///< none: likewise
  /// How long an input must have been safe, without an edge, before it counts as safe. Danger is
  /// never held back: a pulse shorter than this counts, too, and for this long. A cable that picks
  /// up noise therefore stops the rig; filter it where it is wired.
  std::chrono::milliseconds debounce{20};
};

/// The rig's lines on GPIO chips of this computer, by libgpiod (version 1 or 2, as the system has
/// it). The constructor requests every line, with the outputs off, and throws DeviceError
/// (configuration) for a chip or line that cannot be had.
///
/// `read_inputs` reports an input active that was so at any time since the last call, for however
/// short (InputDebounce). An input that can't be read is reported unsafe; it and every other line
/// that failed is requested anew by later calls, at most once a second, the chip being looked for
/// again. An output that comes back is off. No call waits.
///
/// Outputs go to off when it is destroyed. The kernel frees the lines of a process that was killed;
/// its lamp stays on until the next start if the chip is one that goes on driving the last level.
class GpiodLines final : public Lines {
 public:
  using Clock = std::function<std::chrono::steady_clock::time_point()>;

  explicit GpiodLines(const GpiodLinesSettings& settings,
                      std::unique_ptr<GpioChips> chips = make_gpio_chips(),
                      Clock clock = std::chrono::steady_clock::now);
  ~GpiodLines() override;

  SafetyInputs read_inputs() override;
  void set(OutputRole role, bool on) override;

 private:
  using Output = RecoveringLine<GpioOutput>;
  struct Input {
    RecoveringLine<GpioInput> line;
    InputDebounce debounce;
  };

  Input open_input(const char* role, const GpioLineSettings& settings);
  Output open_output(OutputRole role, const GpioLineSettings& settings);
  std::optional<Output> open_output(OutputRole role,
                                    const std::optional<GpioLineSettings>& settings);
  bool is_unsafe(Input& input, std::string& failure);
  Output& output(OutputRole role);
  template <class Act>
  void for_each_output(Act act);

  std::unique_ptr<GpioChips> chips_;
  Clock clock_;
  std::chrono::milliseconds debounce_;
  Input estop_;
  Input door_;
  Output lamp_;
  std::optional<Output> trigger_;
  std::optional<Output> tower_light_;
};

}  // namespace biotomy::bridge
