#include "firmware_bridge/camera/frame_gate.hpp"

#include <algorithm>
#include <utility>

namespace biotomy::bridge {

namespace {

constexpr int kStartingFrames = 2;

/// One that was being exposed and one that was being read out.
constexpr int kFramesInFlight = 2;

/// Sensors take up new settings with a delay of up to three frames; a lens is on its way for some
/// more.
constexpr int kUntoldFrames = 3;
constexpr int kUntoldLensFrames = 6;

}  // namespace

void FrameGate::start() {
  starting_ = kStartingFrames;
  last_timestamp_ = Nanoseconds(0);
  if (settings_) untold_ = settings_->lens_position ? kUntoldLensFrames : kUntoldFrames;
}

void FrameGate::ask(const CameraSettings& settings) {
  if (settings_ == settings) return;
  const bool is_lens_moved = !settings_ || settings_->lens_position != settings.lens_position;
  untold_ = settings.lens_position && is_lens_moved ? kUntoldLensFrames : kUntoldFrames;
  settings_ = settings;
}

void FrameGate::open(Nanoseconds now) {
  opened_ = now;
  in_flight_ = is_triggered_ ? 0 : kFramesInFlight;
}

bool FrameGate::was_in_flight(const DeliveredFrame& frame) {
  const Nanoseconds before = std::exchange(last_timestamp_, frame.timestamp);
  if (frame.timestamp == Nanoseconds(0)) return in_flight_-- > 0;
  if (is_triggered_) return frame.timestamp < opened_;
  // A camera's own buffering may hold a frame back by one frame's time before it is stamped.
  Nanoseconds duration = frame.duration;
  if (duration == Nanoseconds(0) && before > Nanoseconds(0)) duration = frame.timestamp - before;
  if (duration == Nanoseconds(0)) return true;
  const Nanoseconds exposure =
      frame.told.exposure.value_or(settings_ ? settings_->exposure : std::chrono::microseconds(0));
  return frame.timestamp - std::max(exposure, duration) < opened_;
}

std::optional<std::string> FrameGate::refusal(const DeliveredFrame& frame) {
  const bool is_in_flight = was_in_flight(frame);
  if (starting_ > 0) {
    --starting_;
    return "the camera is only starting";
  }
  if (is_in_flight) return "it was in flight before";
  if (frame.was_asked_before) return "it was asked for with other settings";
  if (!settings_) return std::nullopt;
  if (auto text = difference(*settings_, frame.told)) return "it was taken with " + *text;
  if (tells_all(offered_, *settings_, frame.told)) {
    untold_ = 0;
  } else if (untold_ > 0) {
    --untold_;
    return "the camera does not say with which settings it was taken";
  }
  return std::nullopt;
}

}  // namespace biotomy::bridge
