#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "firmware_bridge/camera/camera.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {

/// Gives this process, and those that it starts, a /usr/share of their own: what they put there is
/// seen by nobody else and goes with them. libcamera reads the virtual camera's configuration there
/// and nowhere else. Why it can't be done, in words; nothing when it is done. Once a process.
std::optional<std::string> take_own_usr_share();

/// The camera of libcamera's virtual pipeline. It shows images of ours, one after the other and
/// over again, for four frames each.
class VirtualCamera {
 public:
  static constexpr const char* kModel = "Images of Biotomy";

  /// To be asked of it. It has no exposure, and gives frames as fast as they are asked for: those
  /// of an exposure's time, which a real camera's user has to drop, would be hundreds.
  static bridge::CameraSettings settings() { return {.exposure = std::chrono::microseconds(1)}; }

  /// CV_8UC3 in R, G, B, all of one size. For whoever starts libcamera after this.
  explicit VirtualCamera(const std::vector<cv::Mat>& images);

 private:
  TemporaryFolder folder_;
};

}  // namespace biotomy::tests
