#pragma once

#include <chrono>
#include <string>

#include "firmware_bridge/camera/frame.hpp"

namespace biotomy::bridge {

struct CameraSettings {
  std::chrono::microseconds exposure{10000};
  double gain = 1.0;
  double red_gain = 1.0;  ///< white balance; green is 1
  double blue_gain = 1.0;
};

struct CameraDescription {
  std::string model;
  int width = 0;
  int height = 0;
};

/// A camera that takes one still at a time. One thread owns it. Every call throws DeviceError.
class Camera {
 public:
  virtual ~Camera() = default;
  virtual CameraDescription describe() = 0;
  virtual void apply(const CameraSettings& settings) = 0;

  /// A frame whose exposure began after the call: whatever was in flight before is dropped.
  virtual Frame capture(std::chrono::milliseconds time_out) = 0;
};

}  // namespace biotomy::bridge
