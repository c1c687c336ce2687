#include "firmware_bridge/camera/socket_camera.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/rig_device.hpp"
#include "firmware_bridge/wire/shared_frame.hpp"

namespace biotomy::bridge {

namespace {

using Kind = DeviceError::Kind;
using Clock = std::chrono::steady_clock;

// RGB161616 is little-endian on the wire and is copied as it is.
static_assert(std::endian::native == std::endian::little);

cv::Mat copy_image(const FrameMessage& frame, std::span<const std::byte> bytes) {
  cv::Mat image(frame.height, frame.width,
                frame.format == RigPixelFormat::rgb888 ? CV_8UC3 : CV_16UC3);
  const auto stride = static_cast<std::size_t>(frame.stride);
  const auto row_bytes = static_cast<std::size_t>(frame.width) *
                         static_cast<std::size_t>(bytes_per_pixel(frame.format));
  for (int row = 0; row < frame.height; ++row) {
    std::memcpy(image.ptr(row), bytes.data() + static_cast<std::size_t>(row) * stride, row_bytes);
  }
  return image;
}

std::chrono::milliseconds left_until(Clock::time_point deadline) {
  return std::max(std::chrono::milliseconds(0),
                  std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()));
}

}  // namespace

SocketCamera::SocketCamera(const std::filesystem::path& socket, std::chrono::milliseconds time_out)
    : client_(socket, RigService::camera), time_out_(time_out) {}

SocketCamera::~SocketCamera() = default;

std::uint64_t SocketCamera::connect(std::chrono::milliseconds time_out) {
  try {
    return client_.connect(time_out);
  } catch (...) {
    rethrow_as_device_error(client_, "camera");
  }
}

CameraDescription SocketCamera::describe() {
  client_.disconnect();  // what an earlier connection told may be of a rig that was restarted since
  connect(time_out_);
  const WelcomeMessage::Camera& camera = *client_.welcome().camera;
  return {.model = camera.model,
          .width = camera.width,
          .height = camera.height,
          .transfer = camera.transfer};
}

void SocketCamera::apply(const CameraSettings& settings) {
  if (settings.lens_position) {
    throw DeviceError(Kind::refused, "camera at unix://" + client_.path().string() +
                                         ": it has no lens that can be driven");
  }
  settings_ = settings;
  send_settings(time_out_);
}

void SocketCamera::send_settings(std::chrono::milliseconds time_out) {
  const Clock::time_point deadline = Clock::now() + time_out;
  const std::uint64_t connection = connect(time_out);
  const ConfigureMessage message{
      .exposure_us = std::chrono::duration<double, std::micro>(settings_->exposure).count(),
      .gain = settings_->gain,
      .red_gain = settings_->red_gain,
      .blue_gain = settings_->blue_gain};
  ask_device(client_, "camera", message, "configured", left_until(deadline));
  configured_connection_ = connection;
}

Frame SocketCamera::capture(std::chrono::milliseconds time_out) {
  const Clock::time_point deadline = Clock::now() + time_out;
  if (connect(time_out) != configured_connection_ && settings_) {
    send_settings(left_until(deadline));
  }
  const RigAnswer answer =
      ask_device(client_, "camera", CaptureMessage{}, "frame", left_until(deadline));
  const auto& message = std::get<FrameMessage>(answer.message);
  const WelcomeMessage::Camera& camera = *client_.welcome().camera;
  if (message.width != camera.width || message.height != camera.height) {
    throw DeviceError(Kind::refused, "camera at unix://" + client_.path().string() + ": it sent " +
                                         std::to_string(message.width) + " x " +
                                         std::to_string(message.height) + " pixels and is " +
                                         std::to_string(camera.width) + " x " +
                                         std::to_string(camera.height));
  }
  try {
    const std::size_t size =
        static_cast<std::size_t>(message.stride) * static_cast<std::size_t>(message.height);
    const MappedFrame mapped(answer.descriptor, size);
    return {.image = copy_image(message, mapped.bytes()),
            .sequence = message.sequence,
            .sensor_timestamp = std::chrono::nanoseconds(message.timestamp_ns),
            .exposure = std::chrono::microseconds(std::llround(message.exposure_us)),
            .gain = message.gain};
  } catch (...) {
    rethrow_as_device_error(client_, "camera");
  }
}

}  // namespace biotomy::bridge
