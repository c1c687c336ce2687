#include "acquisition/rig/watched_camera.hpp"

#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {

bridge::Frame WatchedCamera::capture(std::chrono::milliseconds time_out) {
  try {
    bridge::Frame frame = camera_.capture(time_out);
    if (!frame.remark.empty()) note(frame.remark);
    return frame;
  } catch (const bridge::DeviceError& error) {
    note(std::string("no frame: ") + error.what());
    throw;
  }
}

std::vector<WatchedCamera::Trouble> WatchedCamera::take_troubles() {
  const std::lock_guard lock(mutex_);
  return std::exchange(troubles_, {});
}

void WatchedCamera::note(const std::string& sentence) {
  const std::lock_guard lock(mutex_);
  troubles_.push_back({now_(), sentence});
}

}  // namespace biotomy::acquisition
