#include "tests/kernel/usb_camera.hpp"

#include <algorithm>

#include <linux/usb/video.h>

#include "tests/kernel/usb_bytes.hpp"

namespace biotomy::tests {

namespace {

constexpr std::uint8_t kProbe = UVC_VS_PROBE_CONTROL;
constexpr std::uint8_t kCommit = UVC_VS_COMMIT_CONTROL;

std::uint8_t high(std::uint16_t word) {
  return static_cast<std::uint8_t>(word >> 8U);
}
std::uint8_t low(std::uint16_t word) {
  return static_cast<std::uint8_t>(word & 0xffU);
}

}  // namespace

UsbCamera::UsbCamera(const std::vector<FrameSize>& sizes, int frames_per_second,
                     const std::string& model, FrameSource& source)
    : sizes_(sizes),
      interval_(frame_interval(frames_per_second)),
      descriptors_(usb_camera_descriptors(sizes, frames_per_second, model)),
      stream_(gadget_, source, frames_per_second) {}

void UsbCamera::run() {
  for (;;) obey(gadget_.next_request());
}

void UsbCamera::obey(const usb_ctrlrequest& request) {
  switch (request.bRequestType & USB_TYPE_MASK) {
    case USB_TYPE_STANDARD:
      return obey_standard(request);
    case USB_TYPE_CLASS:
      return obey_class(request);
    default:
      return gadget_.stall();
  }
}

void UsbCamera::obey_standard(const usb_ctrlrequest& request) {
  switch (request.bRequest) {
    case USB_REQ_GET_DESCRIPTOR:
      return describe(request);
    case USB_REQ_SET_CONFIGURATION:
      if (endpoint_ < 0) endpoint_ = gadget_.enable(descriptors_.endpoint);
      gadget_.set_configured();
      gadget_.take(request);
      return;
    case USB_REQ_SET_INTERFACE:
      gadget_.take(request);
      return;
    case USB_REQ_GET_CONFIGURATION:
      return gadget_.answer(request, std::vector<std::uint8_t>{1});
    case USB_REQ_GET_INTERFACE:
      return gadget_.answer(request, std::vector<std::uint8_t>{0});
    default:
      return gadget_.stall();
  }
}

void UsbCamera::describe(const usb_ctrlrequest& request) {
  const std::size_t index = low(request.wValue);
  switch (high(request.wValue)) {
    case USB_DT_DEVICE:
      return gadget_.answer(request, descriptors_.device);
    case USB_DT_DEVICE_QUALIFIER:
      return gadget_.answer(request, descriptors_.qualifier);
    case USB_DT_CONFIG:
      return gadget_.answer(request, descriptors_.configuration);
    case USB_DT_STRING:
      if (index >= descriptors_.strings.size()) return gadget_.stall();
      return gadget_.answer(request, descriptors_.strings[index]);
    default:
      return gadget_.stall();
  }
}

/// The host proposes a size (probe), asks what became of it, and then means it (commit).
void UsbCamera::obey_class(const usb_ctrlrequest& request) {
  const std::uint8_t selector = high(request.wValue);
  const bool is_ours =
      low(request.wIndex) == kStreamingInterface && (selector == kProbe || selector == kCommit);
  if (!is_ours) return gadget_.stall();

  if (request.bRequest == UVC_SET_CUR) {
    // Once the host has an answer to its commit it fetches frames: the earlier ones end before.
    if (selector == kCommit) stream_.start(endpoint_, sizes_[chosen_]);
    return negotiate(gadget_.take(request));
  }
  switch (request.bRequest) {
    case UVC_GET_INFO:
      return gadget_.answer(request,
                            std::vector<std::uint8_t>{UVC_CONTROL_CAP_GET | UVC_CONTROL_CAP_SET});
    case UVC_GET_LEN:
      return gadget_.answer(request, UsbBytes().u16(negotiated().size()).get());
    default:
      return gadget_.answer(request, negotiated());
  }
}

void UsbCamera::negotiate(const std::vector<std::uint8_t>& wish) {
  constexpr std::size_t kFrameIndex = 3;
  if (wish.size() <= kFrameIndex) return;
  chosen_ = std::clamp<std::size_t>(wish[kFrameIndex], 1, sizes_.size()) - 1;
}

std::vector<std::uint8_t> UsbCamera::negotiated() const {
  UsbBytes state;
  state.u16(1).u8({1, static_cast<unsigned>(chosen_ + 1)}).u32(interval_);
  state.u16(0).u16(0).u16(0).u16(0).u16(0);
  state.u32(kMostBytesInAFrame).u32(kMostBytesInAFrame + kPayloadHeaderBytes);
  return state.get();
}

}  // namespace biotomy::tests
