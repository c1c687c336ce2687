#include "tests/kernel/usb_descriptors.hpp"

#include "tests/kernel/usb_bytes.hpp"

namespace biotomy::tests {

namespace {

using Bytes = std::vector<std::uint8_t>;

// Of the USB Video Class specification, appendix A.
constexpr unsigned kClassInterface = 0x24;
constexpr unsigned kVideo = 14;
constexpr unsigned kVideoControl = 1;
constexpr unsigned kVideoStreaming = 2;
constexpr unsigned kInterfaceCollection = 3;

constexpr unsigned kCameraTerminal = 1;
constexpr unsigned kStreamingTerminal = 2;

constexpr unsigned kBulkPacket = 512;  // bytes, at high speed

Bytes interface(unsigned number, unsigned endpoints, unsigned subclass) {
  return UsbBytes()
      .u8({USB_DT_INTERFACE_SIZE, USB_DT_INTERFACE, number, 0, endpoints, kVideo, subclass, 0, 0})
      .get();
}

/// A camera, wired to the stream.
Bytes video_control() {
  UsbBytes camera;
  camera.u8({18, kClassInterface, 2, kCameraTerminal}).u16(0x0201).u8({0, 0});
  camera.u16(0).u16(0).u16(0).u8({3, 0, 0, 0});  // no zoom, no controls
  UsbBytes stream;
  stream.u8({9, kClassInterface, 3, kStreamingTerminal}).u16(0x0101).u8({0, kCameraTerminal, 0});
  UsbBytes header;
  header.u8({13, kClassInterface, 1}).u16(0x0100).u16(13 + camera.size() + stream.size());
  header.u32(kClockHz).u8({1, kStreamingInterface});
  return header.append(camera.get()).append(stream.get()).get();
}

Bytes frame_descriptor(unsigned index, const FrameSize& size, std::uint32_t interval) {
  const auto pixels = static_cast<std::uint32_t>(size.width * size.height);
  UsbBytes frame;
  frame.u8({30, kClassInterface, 7, index, 0});
  frame.u16(static_cast<unsigned>(size.width)).u16(static_cast<unsigned>(size.height));
  frame.u32(pixels * 8).u32(pixels * 160);  // bits a second, least and most
  frame.u32(kMostBytesInAFrame).u32(interval).u8({1}).u32(interval);
  return frame.get();
}

Bytes video_streaming(const std::vector<FrameSize>& sizes, std::uint32_t interval,
                      unsigned endpoint) {
  UsbBytes formats;
  formats.u8({11, kClassInterface, 6, 1, static_cast<unsigned>(sizes.size()), 1, 1, 0, 0, 0, 0});
  for (unsigned i = 0; i < sizes.size(); ++i) {
    formats.append(frame_descriptor(i + 1, sizes[i], interval));
  }
  formats.u8({6, kClassInterface, 13, 1, 1, 4});  // colours: sRGB's primaries, BT.601's matrix
  UsbBytes header;
  header.u8({14, kClassInterface, 1, 1}).u16(14 + formats.size());
  header.u8({endpoint, 0, kStreamingTerminal, 0, 0, 0, 1, 0});
  return header.append(formats.get()).get();
}

Bytes text_descriptor(const std::string& text) {
  UsbBytes descriptor;
  descriptor.u8({static_cast<unsigned>(2 + 2 * text.size()), USB_DT_STRING});
  for (const char letter : text) descriptor.u16(static_cast<unsigned char>(letter));
  return descriptor.get();
}

}  // namespace

std::uint32_t frame_interval(int frames_per_second) {
  return static_cast<std::uint32_t>(10'000'000 / frames_per_second);
}

UsbDescriptors usb_camera_descriptors(const std::vector<FrameSize>& sizes, int frames_per_second,
                                      const std::string& model) {
  UsbDescriptors descriptors;

  usb_endpoint_descriptor& endpoint = descriptors.endpoint;
  endpoint.bLength = USB_DT_ENDPOINT_SIZE;
  endpoint.bDescriptorType = USB_DT_ENDPOINT;
  endpoint.bEndpointAddress = USB_DIR_IN | 1U;
  endpoint.bmAttributes = USB_ENDPOINT_XFER_BULK;
  endpoint.wMaxPacketSize = kBulkPacket;

  // Class "several interfaces that belong together"; the vendor's number is the Linux Foundation's.
  UsbBytes device;
  device.u8({USB_DT_DEVICE_SIZE, USB_DT_DEVICE}).u16(0x0200).u8({0xef, 2, 1, 64});
  device.u16(0x1d6b).u16(0x0102).u16(0x0100).u8({1, 2, 3, 1});
  descriptors.device = device.get();
  descriptors.qualifier =
      UsbBytes().u8({10, USB_DT_DEVICE_QUALIFIER}).u16(0x0200).u8({0xef, 2, 1, 64, 1, 0}).get();

  UsbBytes interfaces;
  interfaces.u8({8, USB_DT_INTERFACE_ASSOCIATION, 0, 2, kVideo, kInterfaceCollection, 0, 0});
  interfaces.append(interface(0, 0, kVideoControl)).append(video_control());
  interfaces.append(interface(kStreamingInterface, 1, kVideoStreaming));
  interfaces.append(
      video_streaming(sizes, frame_interval(frames_per_second), endpoint.bEndpointAddress));
  interfaces.u8({endpoint.bLength, endpoint.bDescriptorType, endpoint.bEndpointAddress,
                 endpoint.bmAttributes});
  interfaces.u16(kBulkPacket).u8({0});
  UsbBytes configuration;
  configuration.u8({USB_DT_CONFIG_SIZE, USB_DT_CONFIG}).u16(USB_DT_CONFIG_SIZE + interfaces.size());
  configuration.u8({2, 1, 0, USB_CONFIG_ATT_ONE, 50});
  descriptors.configuration = configuration.append(interfaces.get()).get();

  constexpr unsigned kEnglish = 0x0409;
  descriptors.strings = {UsbBytes().u8({4, USB_DT_STRING}).u16(kEnglish).get(),
                         text_descriptor("Biotomy"), text_descriptor(model),
                         text_descriptor("0001")};
  return descriptors;
}

}  // namespace biotomy::tests
