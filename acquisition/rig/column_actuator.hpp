#pragma once

#include "acquisition/focus/focus_actuator.hpp"
#include "acquisition/rig/stage_commands.hpp"

namespace biotomy::acquisition {

/// Focuses with the column. A position is the column's own.
class ColumnActuator : public FocusActuator {
 public:
  ColumnActuator(StageCommands& commands, const SafetyLimits& limits, bridge::AxisLimits column);

  const char* name() const override { return "column"; }
  bridge::AxisLimits limits() const override { return column_; }
  void move_to(bridge::Micrometres target, TimePoint now) override;
  bool settled(const bridge::StageStatus& status, TimePoint now) override;
  std::optional<bridge::Micrometres> reported(const bridge::StageStatus& status) const override;
  std::string describe(bridge::Micrometres position) const override;

 private:
  StageCommands& commands_;
  const SafetyLimits& limits_;
  bridge::AxisLimits column_;
  bridge::Micrometres target_{};
};

}  // namespace biotomy::acquisition
