#include "tests/kernel/plugged_camera.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>

#include <opencv2/imgcodecs.hpp>

#include "tests/kernel/swapped_colours.hpp"

namespace biotomy::tests {

namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr const char* kSizes[] = {"640x480", "320x240"};

std::vector<std::uint8_t> jpeg(const cv::Mat& picture) {
  std::vector<std::uint8_t> file;
  cv::imencode(".jpg", swapped_colours(picture), file, {cv::IMWRITE_JPEG_QUALITY, 90});
  return file;
}

bool is_known_to_the_kernel() {
  for (const auto& device : fs::directory_iterator("/sys/class/video4linux")) {
    std::ifstream file(device.path() / "name");
    const std::string name((std::istreambuf_iterator<char>(file)), {});
    if (name.starts_with(kUsbModel)) return true;
  }
  return false;
}

void await_known(bool known) {
  const auto deadline = steady_clock::now() + seconds(30);
  while (is_known_to_the_kernel() != known) {
    if (steady_clock::now() > deadline) {
      throw std::runtime_error(known ? "the kernel does not see the USB camera"
                                     : "the kernel still sees the USB camera");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  // libcamera looks at devices that udevd has taken up.
  run({"/usr/bin/env", "udevadm", "settle"}, fs::temp_directory_path());
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
  await_known(true);
}

void PluggedCamera::unplug() {
  process_->send(SIGKILL);
  process_->wait(seconds(10));
  process_.reset();
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
