#include "acquisition/quality/brightness_plane.hpp"

#include <cstdint>

namespace biotomy::acquisition {
namespace {

template <typename Sample>
void take(const cv::Mat& image, const cv::Rect& part, const ClippingLevels& levels,
          BrightnessPlane& plane) {
  constexpr float kScale = 0.25F / static_cast<float>(std::numeric_limits<Sample>::max());
  for (int y = 0; y < part.height; ++y) {
    const Sample* pixels = image.ptr<Sample>(part.y + y) + 3L * part.x;
    float* out = plane.row(y);
    for (int x = 0; x < part.width; ++x, pixels += 3) {
      const auto sum = static_cast<float>(static_cast<std::uint32_t>(pixels[0]) +
                                          2U * static_cast<std::uint32_t>(pixels[1]) +
                                          static_cast<std::uint32_t>(pixels[2]));
      out[x] = is_clipped(pixels, levels) ? BrightnessPlane::kNothing : kScale * sum;
    }
  }
}

}  // namespace

void take_brightness(const cv::Mat& image, const cv::Rect& part, const ClippingLevels& levels,
                     BrightnessPlane& plane) {
  plane.resize(part.width, part.height);
  if (image.depth() == CV_16U) {
    take<std::uint16_t>(image, part, levels, plane);
  } else {
    take<std::uint8_t>(image, part, levels, plane);
  }
}

void halve(const BrightnessPlane& from, BrightnessPlane& to) {
  to.resize(from.width / 2, from.height / 2);
  for (int y = 0; y < to.height; ++y) {
    const float* upper = from.row(2 * y);
    const float* lower = from.row(2 * y + 1);
    float* out = to.row(y);
    for (int x = 0; x < to.width; ++x) {
      const std::ptrdiff_t left = 2L * x;
      out[x] = 0.25F * (upper[left] + upper[left + 1] + lower[left] + lower[left + 1]);
    }
  }
}

}  // namespace biotomy::acquisition
