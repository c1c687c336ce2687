#include "acquisition/rig/retraction.hpp"

#include <array>
#include <cstdio>

#include "acquisition/rig/stage_checks.hpp"

namespace biotomy::acquisition {

Retraction::Retraction(StageCommands& commands, const SafetyLimits& limits)
    : commands_(commands), limits_(limits) {}

void Retraction::begin(TimePoint now) {
  retracted_ = false;
  commands_.begin({.action = bridge::StageAction::retract}, now);
}

bool Retraction::poll(const bridge::StageStatus& status, TimePoint now) {
  if (!retracted_) {
    if (!commands_.poll_done(status, now)) return false;
    check_position("traverse", status.traverse, {0.0}, limits_);
    retracted_ = true;
  }
  spindle_rpm_ = status.spindle_rpm;
  return wheel_stands(status, limits_);
}

std::string Retraction::waiting_for() const {
  if (!retracted_) return "waits for the wheel to be retracted and the block parked";
  std::array<char, 120> text{};
  std::snprintf(text.data(), text.size(),
                "waits for the wheel to stand: it is retracted and turns at %.0f rpm",
                spindle_rpm_);
  return text.data();
}

}  // namespace biotomy::acquisition
