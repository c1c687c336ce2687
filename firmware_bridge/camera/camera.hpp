#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "firmware_bridge/camera/frame.hpp"
#include "firmware_bridge/wire/transfer.hpp"

namespace biotomy::bridge {

struct CameraSettings {
  std::chrono::microseconds exposure{10000};
  double gain = 1.0;
  double red_gain = 1.0;  ///< white balance; green is 1
  double blue_gain = 1.0;
  /// Where the lens focuses, in dioptres: the reciprocal of the distance in metres. Not set: the
  /// lens is left alone.
  std::optional<double> lens_position{};

  friend bool operator==(const CameraSettings&, const CameraSettings&) = default;
};

/// How far a lens can be driven, in dioptres.
struct LensRange {
  double farthest = 0.0;  ///< 0 is infinity
  double nearest = 0.0;
};

struct CameraDescription {
  std::string model;
  int width = 0;
  int height = 0;
  std::optional<LensRange> lens{};     ///< of a camera that can drive its lens
  Transfer transfer = Transfer::srgb;  ///< of its frames; of a camera that doesn't tell, too
  std::string correction = {};         ///< what was done to its frames, in words; empty if nothing
};

/// A camera that takes one still at a time. One thread owns it. Every call throws DeviceError.
class Camera {
 public:
  virtual ~Camera() = default;
  virtual CameraDescription describe() = 0;

  /// Settings that it cannot follow are refused; a lens position by a camera without such a lens.
  virtual void apply(const CameraSettings& settings) = 0;

  /// A frame whose exposure began after the call: whatever was in flight before is dropped.
  virtual Frame capture(std::chrono::milliseconds time_out) = 0;
};

}  // namespace biotomy::bridge
