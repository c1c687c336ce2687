#include "firmware_bridge/camera/camera_sync.hpp"

#include <thread>
#include <utility>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/lines/gpio_line_request.hpp"

namespace biotomy::bridge {

CameraSync::CameraSync(const CameraSyncSettings& settings, std::unique_ptr<GpioChips> chips)
    : settings_(settings), chips_(std::move(chips)) {
  if (settings_.mode == CameraSyncSettings::Mode::none) return;
  line_.emplace(
      "lines.trigger",
      [request = GpioLineRequest(*chips_, settings_.line)]() mutable { return request.output(); },
      std::chrono::steady_clock::now);
}

CameraSync::~CameraSync() {
  end_capture();
}

void CameraSync::set(bool active) {
  line_->use([active](GpioOutput& line) { line.set_active(active); });
}

void CameraSync::begin_capture() {
  if (settings_.mode == CameraSyncSettings::Mode::strobe) set(true);
}

void CameraSync::trigger() {
  if (!is_trigger()) return;
  set(true);
  std::this_thread::sleep_for(settings_.pulse);
  set(false);
}

void CameraSync::end_capture() noexcept {
  if (!line_ || line_->is_lost()) return;
  try {
    set(false);
  } catch (const DeviceError&) {
    // The chip is gone: the next capture says so.
  }
}

}  // namespace biotomy::bridge
