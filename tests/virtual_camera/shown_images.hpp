#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace biotomy::tests {

/// Until then all requests that a capture left under way are back. The daemon takes its time
/// between captures, too.
constexpr std::chrono::milliseconds kBetweenCaptures{50};

/// The images to give to a VirtualCamera, so that each of so many captures by a LibcameraCamera,
/// one after the other, gets its own of `wanted`. A capture drops frames and the virtual camera
/// goes on with each; how many is found by asking for numbered images first.
std::vector<cv::Mat> shown_in_turn(const std::vector<cv::Mat>& wanted);

}  // namespace biotomy::tests
