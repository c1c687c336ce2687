#include "sim/physics/colour_mosaic.hpp"

#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace biotomy::sim {
namespace {

template <typename Number>
cv::Mat mosaic_of(const cv::Mat& photograph) {
  cv::Mat mosaic(photograph.size(), CV_MAKETYPE(photograph.depth(), 1));
  for (int y = 0; y < mosaic.rows; ++y) {
    const auto* colours = photograph.ptr<Number>(y);
    auto* out = mosaic.ptr<Number>(y);
    for (int x = 0; x < mosaic.cols; ++x) out[x] = colours[3 * x + (x % 2) + (y % 2)];
  }
  return mosaic;
}

}  // namespace

void interpolate_mosaic(cv::Mat& photograph) {
  const cv::Mat mosaic = photograph.depth() == CV_16U ? mosaic_of<std::uint16_t>(photograph)
                                                      : mosaic_of<std::uint8_t>(photograph);
  // OpenCV names a mosaic by its second row's second and third pixel.
  cv::demosaicing(mosaic, photograph, cv::COLOR_BayerBG2RGB);
}

}  // namespace biotomy::sim
