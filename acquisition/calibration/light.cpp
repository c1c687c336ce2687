#include "acquisition/calibration/light.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

namespace biotomy::acquisition {
namespace {

template <typename Value>
cv::Mat light_of_srgb(const cv::Mat& image) {
  const auto& light_of_value = bridge::srgb_tables<Value>().light;
  cv::Mat light(image.size(), CV_16UC3);
  cv::parallel_for_({0, image.rows}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      const auto* values = image.ptr<Value>(y);
      std::transform(values, values + 3 * static_cast<std::ptrdiff_t>(image.cols),
                     light.ptr<std::uint16_t>(y),
                     [&](Value value) { return light_of_value[value]; });
    }
  });
  return light;
}

}  // namespace

cv::Mat light_of(const cv::Mat& image, bridge::Transfer transfer) {
  if (transfer == bridge::Transfer::srgb) {
    return image.depth() == CV_16U ? light_of_srgb<std::uint16_t>(image)
                                   : light_of_srgb<std::uint8_t>(image);
  }
  cv::Mat light;
  image.convertTo(light, CV_16U, image.depth() == CV_16U ? 1.0 : 257.0);
  return light;
}

}  // namespace biotomy::acquisition
