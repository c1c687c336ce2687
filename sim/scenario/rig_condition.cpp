#include "sim/scenario/rig_condition.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

namespace biotomy::sim {

namespace {

/// Does to the condition what each fault does.
struct Effect {
  RigCondition& condition;
  double lasted_s;  ///< rig time since it began

  AxisDefects& axis(MachineAxis which) const {
    return which == MachineAxis::feed       ? condition.machine.feed
           : which == MachineAxis::traverse ? condition.machine.traverse
                                            : condition.machine.column;
  }

  void operator()(const EstopPressed&) const { condition.estop_pressed = true; }
  void operator()(const DoorOpen&) const { condition.door_open = true; }
  void operator()(const DoorBounces& fault) const {
    condition.door_open |= std::fmod(lasted_s, fault.period_s) < fault.open_s;
  }

  void operator()(const LampDead&) const { condition.lamp_share = 0; }
  void operator()(const LampDims& fault) const { condition.lamp_share *= fault.share; }
  void operator()(const LampFlickers& fault) const {
    const double dark =
        0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * fault.frequency_hz * lasted_s);
    condition.lamp_share *= 1.0 - dark * (1.0 - fault.share);
  }

  void operator()(const LampLightsUnevenly& fault) const {
    condition.lamp_field.slope_x += fault.slope_x;
    condition.lamp_field.slope_y += fault.slope_y;
  }
  void operator()(const LampChangesColour& fault) const {
    auto& [red, green, blue] = condition.lamp_field.colour;
    red *= fault.red;
    green *= fault.green;
    blue *= fault.blue;
  }

  void operator()(const FaceFrosts& fault) const {
    condition.film.frost = {.share = fault.share, .opacity = fault.opacity};
  }
  void operator()(const FaceGlares& fault) const { condition.film.glare.share += fault.share; }
  void operator()(const BlockShifts& fault) const {
    condition.displacement.x_um += fault.x_um;
    condition.displacement.y_um += fault.y_um;
  }

  void operator()(const CameraHangs&) const { condition.camera.hangs = true; }
  void operator()(const CameraVanishes&) const { condition.camera.vanished = true; }
  void operator()(const CameraGivesOldFrame& fault) const {
    condition.camera.gives_old_frame = true;
    condition.camera.gives_old_number = fault.under_old_number;
  }
  void operator()(const CameraTearsFrame& fault) const { condition.camera.torn_at = fault.share; }
  void operator()(const CameraGivesBlackFrame&) const { condition.camera.gives_black_frame = true; }
  void operator()(const CameraGivesWrongSize& fault) const {
    condition.camera.wrong_size = {fault.width, fault.height};
  }

  void operator()(const ControllerPowerCut&) const { condition.controller_powered = false; }
  void operator()(const ControllerHeartbeatStops&) const {
    condition.controller_heartbeat_stopped = true;
  }
  void operator()(const ModbusSilent&) const { condition.modbus_silent = true; }
  void operator()(const LinesSilent&) const { condition.lines_silent = true; }

  void operator()(const AxisStalls& fault) const { axis(fault.axis).stalled = true; }
  void operator()(const AxisCreeps& fault) const {
    axis(fault.axis).creep_um_s += fault.speed_um_s;
  }
  void operator()(const AxisReadsWrong& fault) const {
    axis(fault.axis).read_error_um += fault.error_um;
  }

  void operator()(const SpindleOverloaded& fault) const {
    condition.machine.extra_load_percent += fault.load_percent;
  }
  void operator()(const SpindleWontStart&) const { condition.machine.spindle_blocked = true; }
  void operator()(const SpindleWontStop&) const { condition.machine.spindle_runs_on = true; }
  void operator()(const GrindRemovesNothing&) const {
    condition.machine.wheel_short_um = std::numeric_limits<double>::infinity();
  }
  void operator()(const GrindRemovesTooLittle& fault) const {
    condition.machine.wheel_short_um += fault.short_um;
  }
  void operator()(const DebrisSticks&) const { condition.machine.air_blocked = true; }
  void operator()(const VibrationFromOutside& fault) const {
    condition.machine.extra_vibration_mm_s += fault.velocity_mm_s;
  }
  void operator()(const CoolerFails& fault) const {
    condition.machine.cooler_failed_s = fault.time_constant_s;
  }
};

}  // namespace

RigCondition condition_of(const std::vector<ActiveFault>& faults, double rig_s) {
  RigCondition condition;
  for (const ActiveFault& active : faults) {
    std::visit(Effect{condition, rig_s - active.since_s}, active.fault);
  }
  return condition;
}

}  // namespace biotomy::sim
