#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "firmware_bridge/lines/gpio_chips.hpp"
#include "firmware_bridge/lines/gpio_line_settings.hpp"
#include "firmware_bridge/lines/recovering_line.hpp"

namespace biotomy::bridge {

/// A GPIO line that goes with the exposures of a camera.
struct CameraSyncSettings {
  enum class Mode {
    none,
    trigger,  ///< a pulse makes the camera expose, once
    strobe,   ///< active while frames are taken: a lamp that is on for the exposures alone
  };
  Mode mode = Mode::none;
  GpioLineSettings line{};
  std::chrono::microseconds pulse{1000};  ///< how long a trigger is active
};

/// The line, as a capture uses it. It is inactive between captures and when this is destroyed.
/// Every call throws DeviceError; a line whose chip went away is requested anew by later ones.
class CameraSync {
 public:
  explicit CameraSync(const CameraSyncSettings& settings,
                      std::unique_ptr<GpioChips> chips = make_gpio_chips());
  ~CameraSync();
  CameraSync(const CameraSync&) = delete;
  CameraSync& operator=(const CameraSync&) = delete;

  bool is_trigger() const { return settings_.mode == CameraSyncSettings::Mode::trigger; }

  void begin_capture();
  void trigger();
  void end_capture() noexcept;

 private:
  void set(bool active);

  CameraSyncSettings settings_;
  std::unique_ptr<GpioChips> chips_;
  std::optional<RecoveringLine<GpioOutput>> line_;
};

}  // namespace biotomy::bridge
