#include "tests/virtual_camera/virtual_camera.hpp"

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sched.h>
#include <sys/mount.h>

namespace biotomy::tests {
namespace {

constexpr const char* kSystemFolder = "/usr/share";
constexpr const char* kConfigurationFolder = "/usr/share/libcamera/pipeline/virtual";

std::string failure(const std::string& what) {
  return what + ": " + std::generic_category().message(errno);
}

}  // namespace

std::optional<std::string> take_own_usr_share() {
  if (::unshare(CLONE_NEWNS) != 0) return failure("it needs root, to have mounts of its own");
  // What is mounted from here on stays here.
  if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) {
    return failure("mounts of its own cannot be hidden");
  }
  // Memory first: an overlay takes what is written only where it is no overlay itself.
  const TemporaryFolder memory;
  if (::mount("tmpfs", memory.path().c_str(), "tmpfs", 0, nullptr) != 0) {
    return failure("no memory can be mounted");
  }
  std::filesystem::create_directory(memory / "written");
  std::filesystem::create_directory(memory / "work");
  const std::string layers = std::string("lowerdir=") + kSystemFolder +
                             ",upperdir=" + (memory / "written").string() +
                             ",workdir=" + (memory / "work").string();
  const int result = ::mount("overlay", kSystemFolder, "overlay", 0, layers.c_str());
  const std::string why = failure(std::string("nothing can be laid over ") + kSystemFolder);
  ::umount2(memory.path().c_str(), MNT_DETACH);  // the overlay holds it as long as it is needed
  if (result != 0) return why;
  return std::nullopt;
}

namespace {

/// What a reader that takes a JPEG's levels of 0 to 255 for the levels of video, 16 to 235 for Y
/// and 16 to 240 for Cb and Cr, makes into `rgb`. libcamera's virtual pipeline hands out the levels
/// of the JPEG and does not say so; what doesn't say is read as video.
cv::Mat coded_as_video(const cv::Mat& rgb) {
  // Y is scaled by 219/255, the colours' distance from it by 224/255; Y by ITU-R BT.601.
  constexpr double kLuma = (219.0 - 224.0) / 255.0;
  constexpr double kColour = 224.0 / 255.0;
  const cv::Matx34d coding(kColour + kLuma * 0.299, kLuma * 0.587, kLuma * 0.114, 16.0,  //
                           kLuma * 0.299, kColour + kLuma * 0.587, kLuma * 0.114, 16.0,  //
                           kLuma * 0.299, kLuma * 0.587, kColour + kLuma * 0.114, 16.0);
  cv::Mat coded;
  cv::transform(rgb, coded, coding);
  return coded;
}

}  // namespace

VirtualCamera::VirtualCamera(const std::vector<cv::Mat>& images) {
  for (std::size_t i = 0; i < images.size(); ++i) {
    cv::Mat bgr;
    cv::cvtColor(coded_as_video(images[i]), bgr, cv::COLOR_RGB2BGR);
    const std::string file = folder_ / (std::to_string(i) + ".jpg");
    if (!cv::imwrite(file, bgr, {cv::IMWRITE_JPEG_QUALITY, 100})) {
      throw std::runtime_error("cannot write " + file);
    }
  }
  std::filesystem::create_directories(kConfigurationFolder);
  std::ofstream(std::filesystem::path(kConfigurationFolder) / "virtual.yaml")
      << "\"Virtual0\":\n  supported_formats:\n  - width: " << images.front().cols
      << "\n    height: " << images.front().rows
      << "\n    frame_rates: [30]\n  frames:\n    path: \"" << folder_.path().string()
      << "\"\n  model: \"" << kModel << "\"\n";
  ::setenv("LIBCAMERA_PIPELINES_MATCH_LIST", "virtual", 1);
}

}  // namespace biotomy::tests
