#include "tests/virtual_camera/shown_images.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>

#include <opencv2/core.hpp>

#include "firmware_bridge/camera/libcamera_camera.hpp"
#include "tests/virtual_camera/virtual_camera.hpp"

namespace biotomy::tests {
namespace {

// An image's number in base 8, a patch of gray for each digit, after one for 0 and one for 7: what
// conversions do to gray they do to these two as well.
constexpr int kPatch = 32;
constexpr int kDigits = 3;
constexpr int kPatches = kDigits + 2;
constexpr int kBase = 8;

cv::Range patch(int index) {
  return {index * kPatch, (index + 1) * kPatch};
}

cv::Mat numbered(int number) {
  std::array<int, kPatches> digits{0, kBase - 1};
  for (int i = kPatches - 1; i >= 2; --i, number /= kBase) {
    digits.at(static_cast<std::size_t>(i)) = number % kBase;
  }
  cv::Mat image(kPatch, kPatches * kPatch, CV_8UC3);
  for (int i = 0; i < kPatches; ++i) {
    const int gray = 40 + 24 * digits.at(static_cast<std::size_t>(i));
    image.colRange(patch(i)).setTo(cv::Scalar::all(gray));
  }
  return image;
}

int number_of(const cv::Mat& image) {
  const auto gray = [&](int index) { return cv::mean(image.colRange(patch(index)))[1]; };
  const double zero = gray(0);
  const double step = (gray(1) - zero) / (kBase - 1);
  int number = 0;
  for (int i = 2; i < kPatches; ++i) {
    number = kBase * number + static_cast<int>(std::lround((gray(i) - zero) / step));
  }
  return number;
}

}  // namespace

std::vector<cv::Mat> shown_in_turn(const std::vector<cv::Mat>& wanted) {
  std::vector<cv::Mat> numbers;
  for (int number = 0; number < static_cast<int>(8 * wanted.size()); ++number) {
    numbers.push_back(numbered(number));
  }
  const VirtualCamera shown(numbers);
  bridge::LibcameraCamera camera(bridge::LibcameraSettings{.camera = VirtualCamera::kModel});
  camera.apply(VirtualCamera::settings());
  std::vector<cv::Mat> images;
  for (const cv::Mat& picture : wanted) {
    const int number = number_of(camera.capture(std::chrono::seconds(5)).image);
    // The same image twice, or back at the first: the daemon would get them so, too.
    if (number < static_cast<int>(images.size())) {
      throw std::runtime_error("the virtual camera shows image " + std::to_string(number) +
                               " after " + std::to_string(images.size()) + " were shown");
    }
    images.resize(static_cast<std::size_t>(number) + 1, picture);
    std::this_thread::sleep_for(kBetweenCaptures);
  }
  return images;
}

}  // namespace biotomy::tests
