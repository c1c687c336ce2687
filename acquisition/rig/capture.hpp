#pragma once

#include <chrono>

#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::acquisition {

/// One frame. A camera that did not answer or was gone is asked once more: a lost packet is no
/// reason to wake anybody. Throws DeviceError. To be called by the worker.
bridge::Frame capture(bridge::Camera& camera, std::chrono::milliseconds time_out);

}  // namespace biotomy::acquisition
