#pragma once

#include <memory>
#include <string>
#include <vector>

#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::bridge {

struct LibcameraSettings {
  std::string camera{};  ///< its id, or its model; empty: the first there is
  int width = 0;         ///< with height: the size asked for; 0: the largest offered
  int height = 0;
  /// "BGR888", "RGB888", "NV12", "YUYV" or "MJPEG"; empty: the best offered
  std::string pixel_format{};
};

/// A camera that libcamera knows.
struct ListedCamera {
  std::string id;
  std::string model;
};

/// The cameras there are now; often none. Throws DeviceError if libcamera can't start.
std::vector<ListedCamera> list_libcamera_cameras();

/// A camera of this computer by libcamera, as stills at fixed exposure, gain and white balance as
/// far as it has those controls. At most one in a process. It streams only while capture() runs, so
/// that every frame was begun after the call. Throws DeviceError: `configuration` if there is no
/// such camera or it offers no format we read, `disconnected` when it is unplugged, `timeout`.
class LibcameraCamera final : public Camera {
 public:
  explicit LibcameraCamera(const LibcameraSettings& settings);
  ~LibcameraCamera() override;

  CameraDescription describe() override;
  void apply(const CameraSettings& settings) override;
  Frame capture(std::chrono::milliseconds time_out) override;

 private:
  class Session;
  std::unique_ptr<Session> session_;
};

}  // namespace biotomy::bridge
