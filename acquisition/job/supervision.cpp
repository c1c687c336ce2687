#include "acquisition/job/supervision.hpp"

#include <array>
#include <cstdio>

namespace biotomy::acquisition {
namespace {

std::string degrees(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f °C", value);
  return text.data();
}

std::string milliseconds(std::chrono::milliseconds value) {
  return std::to_string(value.count()) + " ms";
}

}  // namespace

Supervision::Supervision(const SafetyLimits& limits) : limits_(limits) {}

void Supervision::observe(const std::optional<bridge::StageStatus>& status,
                          const bridge::SafetyInputs& inputs, TimePoint now) {
  now_ = now;
  inputs_ = inputs;
  if (!first_observation_) first_observation_ = now;
  if (!status) return;

  if (!last_exchange_ || status->controller_heartbeat != status_.controller_heartbeat) {
    heartbeat_changed_ = now;
  }
  const bool inside = status->block_temperature_c >= limits_.block_temperature_minimum_c &&
                      status->block_temperature_c <= limits_.block_temperature_maximum_c;
  if (inside) {
    outside_window_since_.reset();
  } else if (!outside_window_since_) {
    outside_window_since_ = now;
  }
  last_exchange_ = now;
  status_ = *status;
}

std::optional<std::string> Supervision::cause() const {
  if (auto cause = interlock_cause()) return cause;
  if (last_exchange_) {
    if (status_.state == bridge::ControllerState::faulted) {
      return std::string("the controller is faulted: ") + fault_text(status_.fault_code);
    }
    if (status_.interlocks.watchdog_tripped) {
      return "the controller's watchdog tripped: it missed the daemon's heartbeat";
    }
  }
  return condition_cause();
}

std::optional<std::string> Supervision::standing_cause() const {
  if (auto cause = interlock_cause()) return cause;
  return condition_cause();
}

std::optional<std::string> Supervision::interlock_cause() const {
  if (inputs_.estop_pressed) return "the e-stop is pressed (line)";
  if (inputs_.door_open) return "the door is open (line)";
  if (last_exchange_ && status_.interlocks.estop_pressed) {
    return "the e-stop is pressed (controller)";
  }
  if (last_exchange_ && status_.interlocks.door_open) return "the door is open (controller)";
  return std::nullopt;
}

std::optional<std::string> Supervision::condition_cause() const {
  const std::optional<TimePoint> heard = last_exchange_ ? last_exchange_ : first_observation_;
  if (!heard || now_ - *heard > limits_.link_lost) {
    return "the controller does not answer since more than " + milliseconds(limits_.link_lost) +
           ": check its power and the link";
  }
  if (!last_exchange_) return std::nullopt;
  if (*last_exchange_ - *heartbeat_changed_ > limits_.controller_silent) {
    return "the controller's heartbeat stands still since more than " +
           milliseconds(limits_.controller_silent) + ": its program does not run";
  }
  if (outside_window_since_ && now_ - *outside_window_since_ >= limits_.temperature_delay) {
    return "the block is at " + degrees(status_.block_temperature_c) + ", outside " +
           degrees(limits_.block_temperature_minimum_c) + " to " +
           degrees(limits_.block_temperature_maximum_c);
  }
  return std::nullopt;
}

const char* fault_text(std::uint16_t fault_code) {
  switch (fault_code) {
    case 0:
      return "no fault code";
    case 1:
      return "e-stop";
    case 2:
      return "door";
    case 3:
      return "watchdog";
    case 4:
      return "an axis at its limit";
    case 5:
      return "a drive";
    case 6:
      return "spindle overload";
    default:
      return "an unknown fault code";
  }
}

}  // namespace biotomy::acquisition
