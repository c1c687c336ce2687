#include "firmware_bridge/camera/libcamera_manager.hpp"

#include <cstdlib>
#include <mutex>
#include <system_error>

#include <libcamera/camera_manager.h>

#include "firmware_bridge/device_error.hpp"

namespace biotomy::bridge {

std::shared_ptr<libcamera::CameraManager> shared_camera_manager() {
  static std::mutex mutex;
  static std::weak_ptr<libcamera::CameraManager> running;

  const std::lock_guard lock(mutex);
  if (auto manager = running.lock()) return manager;
  // Not a line of its version at each start, unless somebody asked for more; read once by its log.
  ::setenv("LIBCAMERA_LOG_LEVELS", "*:WARN", 0);
  auto manager = std::make_unique<libcamera::CameraManager>();
  if (const int result = manager->start(); result != 0) {
    throw DeviceError(
        DeviceError::Kind::configuration,
        "camera: libcamera does not start: " + std::generic_category().message(-result));
  }
  std::shared_ptr<libcamera::CameraManager> shared(manager.release(), [](auto* stopped) {
    stopped->stop();
    delete stopped;
  });
  running = shared;
  return shared;
}

}  // namespace biotomy::bridge
