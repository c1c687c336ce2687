#include "tests/kernel/plugged_camera.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <opencv2/imgcodecs.hpp>

#include "tests/kernel/swapped_colours.hpp"
#include "tests/kernel/video_devices.hpp"

namespace biotomy::tests {

namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;

constexpr const char* kSizes[] = {"640x480", "320x240"};

std::vector<std::uint8_t> jpeg(const cv::Mat& picture) {
  std::vector<std::uint8_t> file;
  cv::imencode(".jpg", swapped_colours(picture), file, {cv::IMWRITE_JPEG_QUALITY, 90});
  return file;
}

}  // namespace

cv::Mat as_sent(const cv::Mat& picture) {
  return swapped_colours(cv::imdecode(jpeg(picture), cv::IMREAD_COLOR));
}

void PluggedCamera::plug_in() {
  std::vector<std::string> command{BIOTOMY_USB_CAMERA, "--folder", folder_.path(), "--model",
                                   kUsbModel};
  for (const char* size : kSizes) {
    fs::create_directories(folder_ / size);
    command.insert(command.end(), {"--size", size});
  }
  process_ = std::make_unique<ChildProcess>(command, fs::temp_directory_path());
  await_video_device(kUsbModel, true);
}

void PluggedCamera::unplug() {
  process_->send(SIGKILL);
  process_->wait(seconds(10));
  process_.reset();
  await_video_device(kUsbModel, false);
}

void PluggedCamera::show(const std::vector<cv::Mat>& pictures) {
  for (const char* size : kSizes) {
    fs::remove_all(folder_ / size);
    fs::create_directories(folder_ / size);
  }
  int number = 0;
  for (const cv::Mat& picture : pictures) {
    const std::string size = std::to_string(picture.cols) + "x" + std::to_string(picture.rows);
    const std::vector<std::uint8_t> file = jpeg(picture);
    const fs::path half_written = folder_ / "half-written";
    std::ofstream(half_written, std::ios::binary)
        .write(reinterpret_cast<const char*>(file.data()),
               static_cast<std::streamsize>(file.size()));
    fs::rename(half_written, folder_ / size / (std::to_string(number++) + ".jpg"));
  }
}

}  // namespace biotomy::tests
