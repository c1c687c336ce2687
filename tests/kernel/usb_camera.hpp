#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/kernel/frame_source.hpp"
#include "tests/kernel/raw_gadget.hpp"
#include "tests/kernel/usb_descriptors.hpp"
#include "tests/kernel/usb_stream.hpp"

namespace biotomy::tests {

/// A camera of the USB Video Class, plugged in while the object lives. `source` outlives it.
class UsbCamera {
 public:
  UsbCamera(const std::vector<FrameSize>& sizes, int frames_per_second, const std::string& model,
            FrameSource& source);

  /// Does what the host requests, for ever. Throws std::system_error when the port fails.
  [[noreturn]] void run();

 private:
  void obey(const usb_ctrlrequest& request);
  void obey_standard(const usb_ctrlrequest& request);
  void obey_class(const usb_ctrlrequest& request);
  void describe(const usb_ctrlrequest& request);
  void negotiate(const std::vector<std::uint8_t>& wish);
  std::vector<std::uint8_t> negotiated() const;

  std::vector<FrameSize> sizes_;
  std::uint32_t interval_;
  UsbDescriptors descriptors_;
  RawGadget gadget_;
  UsbStream stream_;
  int endpoint_ = -1;
  std::size_t chosen_ = 0;  ///< of the sizes
};

}  // namespace biotomy::tests
