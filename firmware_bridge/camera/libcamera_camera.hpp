#pragma once

#include <memory>
#include <optional>
#include <string>

#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/camera/camera_sync.hpp"

namespace biotomy::bridge {

struct LibcameraSettings {
  std::string camera{};  ///< its id, or its model; empty: the first there is
  int width = 0;         ///< with height: the size asked for; 0: the largest offered
  int height = 0;
  /// libcamera's name: "BGR888", "RGB888", "YUYV", "NV12", "MJPEG" or a raw Bayer format as
  /// "SRGGB10" or "SBGGR12_CSI2P"; empty: the best offered
  std::string pixel_format{};
  bool raw_is_srgb = true;   ///< code raw frames as sRGB; else in proportion to the light
  int viewfinder_width = 0;  ///< of the small picture beside each frame; 0: none
  CameraSyncSettings sync{};
};

class LibcameraSession;

/// A camera of this computer by libcamera, as stills at fixed exposure, gain and white balance as
/// far as it has those controls. At most one in a process. It streams from the first capture on;
/// a frame is believed when it was exposed after the call and its metadata say that it was taken
/// with the settings asked for. A stream that stands still or is cancelled is configured and
/// started anew, at most twice a capture. Throws DeviceError: `configuration` if there is no such
/// camera or it offers no format we read, `disconnected` while it is unplugged (a later call finds
/// it when it is back), `refused` for settings that it cannot follow or does not obey, `timeout`.
class LibcameraCamera final : public Camera {
 public:
  explicit LibcameraCamera(const LibcameraSettings& settings);
  ~LibcameraCamera() override;

  CameraDescription describe() override;
  void apply(const CameraSettings& settings) override;
  Frame capture(std::chrono::milliseconds time_out) override;

 private:
  LibcameraSession& session();

  LibcameraSettings settings_;
  CameraSync sync_;
  std::optional<CameraSettings> applied_;
  std::unique_ptr<LibcameraSession> session_;
  CameraDescription description_;
};

}  // namespace biotomy::bridge
