#pragma once

#include <string>

#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {

/// A daemon that this machine starves for some seconds is not taken for a dead one.
inline constexpr const char* kPatientController = "watchdog_timeout = 10000\n";

/// The job that is done on the kernel's devices: small, and with time for a machine on which every
/// system call takes many times as long.
inline RigPlan kernel_plan(int layers) {
  RigPlan plan{.width = 320, .height = 240, .layers = layers, .time_scale = 50};
  plan.listen = "rtu://serial-line";
  // A pseudo-terminal keeps no parity bit.
  const std::string serial = "parity = \"none\"\nstop_bits = 2\n";
  plan.twin_stage_settings = serial + kPatientController;
  plan.daemon_stage_settings = serial + "response_timeout_ms = 1000\n";
  plan.daemon_camera_settings = "capture_timeout_ms = 20000\n";
  plan.settle_ms = 20;
  plan.lamp_warm_up_ms = 200;
  plan.tick_ms = 20;
  plan.daemon_settings =
      "commands_per_minute = 10000\n[safety]\nrequire_watchdog = false\nlink_lost_ms = 5000\n"
      "controller_silent_ms = 5000\n"
      "command_start_ms = 10000\naxis_stall_ms = 10000\n";
  return plan;
}

}  // namespace biotomy::tests
