#include "acquisition/rig/capture.hpp"

#include "acquisition/log.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {

namespace {

bridge::Frame take(bridge::Camera& camera, std::chrono::milliseconds time_out) {
  bridge::Frame frame = camera.capture(time_out);
  if (!frame.remark.empty()) log_warning("camera", frame.remark);
  return frame;
}

}  // namespace

bridge::Frame capture(bridge::Camera& camera, std::chrono::milliseconds time_out) {
  try {
    return take(camera, time_out);
  } catch (const bridge::DeviceError& error) {
    const bool can_help = error.kind() == bridge::DeviceError::Kind::timeout ||
                          error.kind() == bridge::DeviceError::Kind::disconnected;
    if (!can_help) throw;
    log_warning("camera", std::string(error.what()) + "; asking once more");
  }
  return take(camera, time_out);
}

}  // namespace biotomy::acquisition
