#include "tests/kernel/raw_gadget.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <linux/usb/raw_gadget.h>
#include <sys/ioctl.h>

namespace biotomy::tests {

namespace {

template <typename Argument>
int control(const bridge::UniqueFd& device, unsigned long operation, Argument argument) {
  for (;;) {
    const int result = ioctl(device.get(), operation, argument);
    if (result >= 0 || errno != EINTR) return result;
  }
}

int checked(int result, const char* what) {
  if (result < 0) throw std::system_error(errno, std::generic_category(), what);
  return result;
}

/// The kernel's header and the bytes behind it, in one piece of memory.
template <typename Header, std::size_t Room>
class Message {
 public:
  explicit Message(const Header& header) { std::memcpy(memory_.data(), &header, sizeof header); }
  void* get() { return memory_.data(); }
  Header header() const {
    Header header;
    std::memcpy(&header, memory_.data(), sizeof header);
    return header;
  }
  std::uint8_t* body() { return memory_.data() + sizeof(Header); }

 private:
  alignas(Header) std::array<std::uint8_t, sizeof(Header) + Room> memory_{};
};

using Transfer = Message<usb_raw_ep_io, RawGadget::kMostBytesInAWrite>;

Transfer transfer(int endpoint, std::size_t length) {
  usb_raw_ep_io header{};
  header.ep = static_cast<__u16>(endpoint);
  header.length = static_cast<__u32>(length);
  return Transfer(header);
}

Transfer transfer(int endpoint, std::span<const std::uint8_t> data) {
  Transfer message = transfer(endpoint, data.size());
  std::copy(data.begin(), data.end(), message.body());
  return message;
}

}  // namespace

RawGadget::RawGadget() : device_(open("/dev/raw-gadget", O_RDWR | O_CLOEXEC)) {
  checked(device_.get(), "/dev/raw-gadget");
  usb_raw_init port{};
  std::strcpy(reinterpret_cast<char*>(port.driver_name), "dummy_udc");
  std::strcpy(reinterpret_cast<char*>(port.device_name), "dummy_udc.0");
  port.speed = USB_SPEED_HIGH;
  checked(control(device_, USB_RAW_IOCTL_INIT, &port), "the USB port dummy_udc.0");
  checked(control(device_, USB_RAW_IOCTL_RUN, 0), "plugging in");
}

usb_ctrlrequest RawGadget::next_request() {
  for (;;) {
    usb_raw_event wanted{};
    wanted.length = sizeof(usb_ctrlrequest);
    Message<usb_raw_event, sizeof(usb_ctrlrequest)> event(wanted);
    checked(control(device_, USB_RAW_IOCTL_EVENT_FETCH, event.get()), "an event of the USB port");
    if (event.header().type != USB_RAW_EVENT_CONTROL) continue;
    usb_ctrlrequest request;
    std::memcpy(&request, event.body(), sizeof request);
    return request;
  }
}

void RawGadget::answer(const usb_ctrlrequest& request, std::span<const std::uint8_t> data) {
  Transfer message = transfer(0, data.first(std::min<std::size_t>(data.size(), request.wLength)));
  checked(control(device_, USB_RAW_IOCTL_EP0_WRITE, message.get()), "an answer to the USB host");
}

std::vector<std::uint8_t> RawGadget::take(const usb_ctrlrequest& request) {
  Transfer message =
      transfer(0, std::min<std::size_t>(request.wLength, RawGadget::kMostBytesInAWrite));
  const int length =
      checked(control(device_, USB_RAW_IOCTL_EP0_READ, message.get()), "the data of the USB host");
  return {message.body(), message.body() + length};
}

void RawGadget::stall() {
  checked(control(device_, USB_RAW_IOCTL_EP0_STALL, 0), "a refusal to the USB host");
}

int RawGadget::enable(const usb_endpoint_descriptor& endpoint) {
  return checked(control(device_, USB_RAW_IOCTL_EP_ENABLE, &endpoint), "the USB endpoint");
}

void RawGadget::set_configured() {
  checked(control(device_, USB_RAW_IOCTL_CONFIGURE, 0), "the USB configuration");
}

bool RawGadget::write(int endpoint, std::span<const std::uint8_t> data) const {
  Transfer message = transfer(endpoint, data);
  return ioctl(device_.get(), USB_RAW_IOCTL_EP_WRITE, message.get()) ==
         static_cast<int>(data.size());
}

}  // namespace biotomy::tests
