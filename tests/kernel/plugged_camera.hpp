#pragma once

#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "tests/integration/child_process.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {

inline constexpr const char* kUsbModel = "Biotomy test camera";

/// What comes of an RGB picture on its way through the camera: a JPEG, read again.
cv::Mat as_sent(const cv::Mat& picture);

/// A USB camera that can be plugged in and out, and what it looks at. It offers 640 × 480 and
/// 320 × 240.
class PluggedCamera {
 public:
  /// Returns once the kernel has taken it up.
  void plug_in();
  void unplug();

  /// It looks at these from now on, one after the other and over again, each in its own size. None:
  /// it has nothing to send. RGB.
  void show(const std::vector<cv::Mat>& pictures);

 private:
  TemporaryFolder folder_;
  std::unique_ptr<ChildProcess> process_;
};

}  // namespace biotomy::tests
