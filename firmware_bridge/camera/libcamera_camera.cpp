#include "firmware_bridge/camera/libcamera_camera.hpp"

#include <string>

#include "firmware_bridge/camera/capture_time_out.hpp"
#include "firmware_bridge/camera/libcamera_session.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::bridge {

namespace {

using Kind = DeviceError::Kind;

std::string size_text(const CameraDescription& camera) {
  return std::to_string(camera.width) + "x" + std::to_string(camera.height);
}

}  // namespace

LibcameraCamera::LibcameraCamera(const LibcameraSettings& settings)
    : settings_(settings),
      sync_(settings.sync),
      session_(std::make_unique<LibcameraSession>(settings_, sync_, Kind::configuration)),
      description_(session_->describe()) {
  // Whatever comes to be the first: it is this one that is looked for after it was unplugged.
  if (settings_.camera.empty()) settings_.camera = session_->id();
}

LibcameraCamera::~LibcameraCamera() = default;

LibcameraSession& LibcameraCamera::session() {
  if (session_ && session_->is_gone()) session_.reset();
  if (!session_) {
    auto session = std::make_unique<LibcameraSession>(settings_, sync_, Kind::disconnected);
    const CameraDescription found = session->describe();
    if (found.width != description_.width || found.height != description_.height) {
      throw DeviceError(Kind::configuration, "camera " + found.model + ": it came back with " +
                                                 size_text(found) + " pixels instead of " +
                                                 size_text(description_) +
                                                 "; is it the same, on the same port?");
    }
    if (applied_) session->apply(*applied_);
    session_ = std::move(session);
  }
  return *session_;
}

CameraDescription LibcameraCamera::describe() {
  session();
  return description_;
}

void LibcameraCamera::apply(const CameraSettings& settings) {
  session().apply(settings);
  applied_ = settings;
}

Frame LibcameraCamera::capture(std::chrono::milliseconds time_out) {
  const auto deadline = LibcameraSession::Clock::now() + time_out;
  const auto exposure = applied_ ? applied_->exposure : std::chrono::microseconds(0);
  const std::chrono::milliseconds silence = longest_silence(time_out, exposure);
  std::string remark;
  for (int left = kSessionsOfACapture - 1;; --left) {
    try {
      Frame frame = session().capture(deadline, silence);
      frame.remark = remark;
      return frame;
    } catch (const CameraStalled& stalled) {
      session_.reset();
      remark = "camera " + description_.model + ": " + stalled.what() + "; it was started anew";
      if (left > 0 && LibcameraSession::Clock::now() < deadline) continue;
      throw DeviceError(Kind::timeout,
                        "camera " + description_.model + ": " + stalled.what() +
                            ", and starting it anew did not help; look at its cable");
    }
  }
}

}  // namespace biotomy::bridge
