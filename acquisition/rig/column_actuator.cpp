#include "acquisition/rig/column_actuator.hpp"

#include <array>
#include <cstdio>

#include "acquisition/rig/stage_checks.hpp"

namespace biotomy::acquisition {

ColumnActuator::ColumnActuator(StageCommands& commands, const SafetyLimits& limits,
                               bridge::AxisLimits column)
    : commands_(commands), limits_(limits), column_(column) {}

void ColumnActuator::move_to(bridge::Micrometres target, TimePoint now) {
  target_ = target;
  commands_.begin({.action = bridge::StageAction::move_column,
                   .position = target,
                   .duration = {},
                   .spindle_rpm = 0.0},
                  now);
}

bool ColumnActuator::settled(const bridge::StageStatus& status, TimePoint now) {
  if (!commands_.poll_done(status, now)) return false;
  check_position("column", status.column, target_, limits_);
  return true;
}

std::optional<bridge::Micrometres> ColumnActuator::reported(
    const bridge::StageStatus& status) const {
  return status.column;
}

std::string ColumnActuator::describe(bridge::Micrometres position) const {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.1f µm", position.value);
  return text.data();
}

}  // namespace biotomy::acquisition
