#include "firmware_bridge/camera/camera_sync.hpp"

#include <thread>

#include "firmware_bridge/device_error.hpp"

namespace biotomy::bridge {

CameraSync::CameraSync(const CameraSyncSettings& settings) : settings_(settings) {
  if (settings_.mode != CameraSyncSettings::Mode::none) {
    line_.emplace(GpioLine::output(settings_.line));
  }
}

CameraSync::~CameraSync() {
  end_capture();
}

void CameraSync::begin_capture() {
  if (settings_.mode == CameraSyncSettings::Mode::strobe) line_->set_active(true);
}

void CameraSync::trigger() {
  if (!is_trigger()) return;
  line_->set_active(true);
  std::this_thread::sleep_for(settings_.pulse);
  line_->set_active(false);
}

void CameraSync::end_capture() noexcept {
  if (!line_) return;
  try {
    line_->set_active(false);
  } catch (const DeviceError&) {
    // The chip is gone: the next capture says so.
  }
}

}  // namespace biotomy::bridge
