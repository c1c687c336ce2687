#pragma once

#include <memory>

namespace libcamera {
class CameraManager;
}

namespace biotomy::bridge {

/// The process's one CameraManager, started: libcamera aborts the program that makes a second. It
/// stops when the last holder lets go. Throws DeviceError (configuration) if it can't start.
std::shared_ptr<libcamera::CameraManager> shared_camera_manager();

}  // namespace biotomy::bridge
