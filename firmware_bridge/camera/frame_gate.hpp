#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "firmware_bridge/camera/told_settings.hpp"

namespace biotomy::bridge {

/// What is known of a frame that a camera delivered.
struct DeliveredFrame {
  std::chrono::nanoseconds timestamp{0};  ///< of its first row, on the clock of `now`; 0: unknown
  std::chrono::nanoseconds duration{0};   ///< from frame to frame, as told; 0: unknown
  ToldSettings told;
  bool was_asked_before = false;  ///< its request was handed over before the settings of now
};

/// Tells which frame of a running stream is the first to be believed: not one that was in flight
/// when it was asked for, nor one taken with other settings. Times are of one clock, in
/// nanoseconds.
class FrameGate {
 public:
  using Nanoseconds = std::chrono::nanoseconds;

  /// `is_triggered`: the camera exposes when told to, so that a frame without a timestamp was not
  /// in flight before.
  FrameGate(const SettingsOffered& offered, bool is_triggered)
      : offered_(offered), is_triggered_(is_triggered) {}

  /// The stream starts anew: a sensor's first frames are not yet exposed as asked.
  void start();

  /// From now on these settings are meant.
  void ask(const CameraSettings& settings);

  /// A frame is wanted whose exposure begins after `now`.
  void open(Nanoseconds now);

  /// Why this frame is not the one, in words; none when it is. Each frame of the stream is to be
  /// shown once, in their order.
  std::optional<std::string> refusal(const DeliveredFrame& frame);

 private:
  bool was_in_flight(const DeliveredFrame& frame);

  SettingsOffered offered_;
  bool is_triggered_;
  std::optional<CameraSettings> settings_;
  int starting_ = 0;   ///< frames still to refuse after the start
  int untold_ = 0;     ///< frames still to refuse after settings of which the camera tells nothing
  int in_flight_ = 0;  ///< frames without a timestamp still to refuse
  Nanoseconds opened_{0};
  Nanoseconds last_timestamp_{0};
};

}  // namespace biotomy::bridge
