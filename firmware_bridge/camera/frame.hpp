#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <opencv2/core/mat.hpp>

namespace biotomy::bridge {

/// One photograph and what the camera said of it.
/// `image` is rows × columns, CV_8UC3 or CV_16UC3, channels in the order R, G, B: the order of the
/// layer files and of the volume. Only where an OpenCV codec is called is it swapped.
struct Frame {
  cv::Mat image;
  std::uint64_t sequence = 0;  ///< the camera's own count; a gap is a lost frame
  std::chrono::nanoseconds sensor_timestamp{
      0};                                 ///< CLOCK_MONOTONIC or CLOCK_BOOTTIME of the camera
  std::chrono::microseconds exposure{0};  ///< as used, not as asked
  double gain = 0.0;                      ///< as used, not as asked
  cv::Mat viewfinder{};                   ///< the same small, for looking at; mostly empty
  std::string remark{};  ///< what the camera went through to give it, in words; mostly empty
};

}  // namespace biotomy::bridge
