#include "acquisition/rig/supervision.hpp"

#include <array>
#include <cstdio>

#include "acquisition/rig/stage_checks.hpp"

namespace biotomy::acquisition {
namespace {

std::string with_unit(double value, const char* unit) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.1f %s", value, unit);
  return text.data();
}

std::string milliseconds(std::chrono::milliseconds value) {
  return std::to_string(value.count()) + " ms";
}

bool is_in_window(const SafetyLimits& limits, double block_temperature_c) {
  return block_temperature_c >= limits.block_temperature_minimum_c &&
         block_temperature_c <= limits.block_temperature_maximum_c;
}

std::string outside_window_text(const SafetyLimits& limits, double block_temperature_c) {
  return "the block is at " + with_unit(block_temperature_c, "°C") + ", outside " +
         with_unit(limits.block_temperature_minimum_c, "°C") + " to " +
         with_unit(limits.block_temperature_maximum_c, "°C");
}

/// By the fault codes of the register map.
AlarmKind kind_of_fault(std::uint16_t fault_code) {
  switch (fault_code) {
    case 1:
      return AlarmKind::emergency_stop;
    case 2:
      return AlarmKind::door;
    case 3:
      return AlarmKind::watchdog;
    case 4:
    case 5:
      return AlarmKind::motion;
    case 6:
      return AlarmKind::wheel;
    default:
      return AlarmKind::controller;
  }
}

}  // namespace

Supervision::Supervision(const SafetyLimits& limits) : limits_(limits), motion_(limits) {}

void Supervision::Excess::observe(bool outside, TimePoint now) {
  if (!outside) {
    since.reset();
  } else if (!since) {
    since = now;
  }
}

bool Supervision::Excess::lasts(std::chrono::milliseconds limit, TimePoint now) const {
  return since && now - *since >= limit;
}

void Supervision::observe(const std::optional<bridge::StageStatus>& status,
                          const bridge::SafetyInputs& inputs, TimePoint now) {
  now_ = now;
  inputs_ = inputs;
  if (!first_observation_) first_observation_ = now;
  if (!status) return;

  if (!last_exchange_ || status->controller_heartbeat != status_.controller_heartbeat) {
    heartbeat_changed_ = now;
  }
  temperature_.observe(!is_in_window(limits_, status->block_temperature_c), now);
  load_.observe(status->spindle_load_percent > limits_.spindle_load_maximum_percent, now);
  vibration_.observe(status->vibration_mm_s > limits_.vibration_maximum_mm_s, now);
  wheel_.observe(wheel_turns(*status, limits_), now);
  motion_.observe(*status, now);
  last_exchange_ = now;
  status_ = *status;
}

std::optional<StopCause> Supervision::cause() const {
  if (auto cause = interlock_cause()) return cause;
  if (last_exchange_) {
    if (status_.state == bridge::ControllerState::faulted) {
      return StopCause{kind_of_fault(status_.fault_code),
                       std::string("the controller is faulted: ") + fault_text(status_.fault_code)};
    }
    if (status_.interlocks.watchdog_tripped) {
      return StopCause{AlarmKind::watchdog,
                       "the controller's watchdog tripped: it missed the daemon's heartbeat"};
    }
  }
  if (auto cause = link_cause()) return cause;
  return machine_cause();
}

std::optional<StopCause> Supervision::standing_cause() const {
  if (auto cause = interlock_cause()) return cause;
  return link_cause();
}

std::optional<StopCause> Supervision::line_cause(const bridge::SafetyInputs& inputs) {
  if (!inputs.failure.empty())
    return StopCause{AlarmKind::lines, "e-stop and door cannot be read: " + inputs.failure};
  if (inputs.estop_pressed)
    return StopCause{AlarmKind::emergency_stop, "the e-stop is pressed (line)"};
  if (inputs.door_open) return StopCause{AlarmKind::door, "the door is open (line)"};
  return std::nullopt;
}

std::optional<StopCause> Supervision::interlock_cause() const {
  if (auto cause = line_cause(inputs_)) return cause;
  if (last_exchange_ && status_.interlocks.estop_pressed) {
    return StopCause{AlarmKind::emergency_stop, "the e-stop is pressed (controller)"};
  }
  if (last_exchange_ && status_.interlocks.door_open)
    return StopCause{AlarmKind::door, "the door is open (controller)"};
  return std::nullopt;
}

std::optional<StopCause> Supervision::link_cause() const {
  const std::optional<TimePoint> heard = last_exchange_ ? last_exchange_ : first_observation_;
  if (!heard || now_ - *heard > limits_.link_lost) {
    return StopCause{AlarmKind::link, "the controller does not answer since more than " +
                                          milliseconds(limits_.link_lost) +
                                          ": check its power and the link"};
  }
  if (last_exchange_ && *last_exchange_ - *heartbeat_changed_ > limits_.controller_silent) {
    return StopCause{AlarmKind::link, "the controller's heartbeat stands still since more than " +
                                          milliseconds(limits_.controller_silent) +
                                          ": its program does not run"};
  }
  return std::nullopt;
}

std::optional<StopCause> Supervision::machine_cause() const {
  if (load_.lasts(limits_.spindle_load_delay, now_)) {
    return StopCause{AlarmKind::wheel,
                     "the spindle's load is " + with_unit(status_.spindle_load_percent, "%") +
                         ", above " + with_unit(limits_.spindle_load_maximum_percent, "%") +
                         ": look at the wheel"};
  }
  if (vibration_.lasts(limits_.vibration_delay, now_)) {
    return StopCause{AlarmKind::wheel, "the spindle vibrates by " +
                                           with_unit(status_.vibration_mm_s, "mm/s") + ", above " +
                                           with_unit(limits_.vibration_maximum_mm_s, "mm/s") +
                                           ": look at the wheel"};
  }
  if (const auto& cause = motion_.cause()) return StopCause{AlarmKind::motion, *cause};
  return std::nullopt;
}

std::optional<StopCause> Supervision::temperature_cause() const {
  if (!temperature_.lasts(limits_.temperature_delay, now_)) return std::nullopt;
  return StopCause{AlarmKind::temperature,
                   outside_window_text(limits_, status_.block_temperature_c)};
}

std::optional<StopCause> Supervision::wheel_cause() const {
  if (!wheel_.lasts(limits_.wheel_delay, now_)) return std::nullopt;
  return StopCause{AlarmKind::wheel, "the wheel turns at " + with_unit(status_.spindle_rpm, "rpm") +
                                         " where it must stand: look at its drive"};
}

std::optional<std::string> temperature_complaint(const SafetyLimits& limits,
                                                 double block_temperature_c) {
  if (is_in_window(limits, block_temperature_c)) return std::nullopt;
  return outside_window_text(limits, block_temperature_c);
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
      return "a drive: an axis or the spindle does not do as it was told";
    case 6:
      return "spindle overload";
    default:
      return "an unknown fault code";
  }
}

}  // namespace biotomy::acquisition
