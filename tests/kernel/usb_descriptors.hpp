#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <linux/usb/ch9.h>

namespace biotomy::tests {

/// A frame size that a camera offers.
struct FrameSize {
  int width = 0;
  int height = 0;
};

/// The numbers of the USB Video Class (its specification, 1.1) that both the descriptors and the
/// answers to requests need.
inline constexpr std::uint8_t kStreamingInterface = 1;
inline constexpr std::uint32_t kClockHz = 48'000'000;
inline constexpr std::uint32_t kMostBytesInAFrame = 1U << 20U;
inline constexpr std::uint32_t kPayloadHeaderBytes = 12;

/// What a USB camera says of itself: Motion-JPEG in some sizes, by bulk transfers, without any
/// controls. Each is what goes over the wire.
struct UsbDescriptors {
  std::vector<std::uint8_t> device;
  std::vector<std::uint8_t> qualifier;
  std::vector<std::uint8_t> configuration;
  std::vector<std::vector<std::uint8_t>> strings;  ///< by their index
  usb_endpoint_descriptor endpoint{};              ///< the one of the configuration
};

/// `model`: ASCII.
UsbDescriptors usb_camera_descriptors(const std::vector<FrameSize>& sizes, int frames_per_second,
                                      const std::string& model);

/// Frame intervals are told in steps of 100 ns.
std::uint32_t frame_interval(int frames_per_second);

}  // namespace biotomy::tests
