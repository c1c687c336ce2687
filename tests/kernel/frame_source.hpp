#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "tests/kernel/usb_descriptors.hpp"

namespace biotomy::tests {

/// What the USB camera looks at. One thread asks.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next frame of this size, as a JPEG file; taken after the call. Throws what is derived from
  /// std::exception: there is none now.
  virtual std::vector<std::uint8_t> next(const FrameSize& size) = 0;
};

/// The files of `folder`/640x480 for a frame of 640 × 480, by name, over and over.
std::unique_ptr<FrameSource> frames_of_folder(const std::filesystem::path& folder);

/// Photographs of the camera behind a rig's socket (firmware_bridge/wire), whatever size it has.
std::unique_ptr<FrameSource> frames_of_rig(const std::filesystem::path& socket);

}  // namespace biotomy::tests
