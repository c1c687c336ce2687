#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "firmware_bridge/device_error.hpp"

namespace biotomy::bridge {

/// A line that is let go when it fails and requested anew at later calls, as a chip on USB needs it
/// that was unplugged and came back. Requests are at least `kRequestInterval` apart and none waits.
template <class Line>
class RecoveringLine {
 public:
  using Clock = std::function<std::chrono::steady_clock::time_point()>;
  using Request = std::function<std::unique_ptr<Line>()>;

  static constexpr std::chrono::milliseconds kRequestInterval{1000};

  /// `name` begins every message. Requests the line; throws what `request` throws, a DeviceError.
  RecoveringLine(std::string name, Request request, Clock clock)
      : name_(std::move(name)),
        request_(std::move(request)),
        clock_(std::move(clock)),
        requested_(clock_()) {
    try {
      line_ = request_();
    } catch (const DeviceError& error) {
      throw DeviceError(error.kind(), name_ + ": " + error.what());
    }
  }

  /// What `act` does with the line. Throws DeviceError (disconnected) when there is no line or
  /// `act` throws; then the line is let go.
  template <class Act>
  auto use(Act act) {
    regain();
    try {
      return act(*line_);
    } catch (const std::exception& error) {
      line_.reset();
      failure_ = name_ + ": the line failed: " + error.what();
      throw DeviceError(DeviceError::Kind::disconnected, failure_);
    }
  }

  bool is_lost() const { return !line_; }

  /// Requests a lost line anew if it is time. Throws DeviceError (disconnected) while it stays
  /// lost.
  void regain() {
    if (line_) return;
    const auto now = clock_();
    if (now - requested_ >= kRequestInterval) {
      requested_ = now;
      try {
        line_ = request_();
        return;
      } catch (const DeviceError& error) {
        failure_ = name_ + ": " + error.what();
      }
    }
    throw DeviceError(DeviceError::Kind::disconnected, failure_);
  }

 private:
  std::string name_;
  Request request_;
  Clock clock_;
  std::chrono::steady_clock::time_point requested_;  ///< last, with or without success
  std::unique_ptr<Line> line_;
  std::string failure_;  ///< why it is lost
};

}  // namespace biotomy::bridge
