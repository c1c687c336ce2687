#include "acquisition/service/safety_section.hpp"

#include "acquisition/service/configuration_keys.hpp"

namespace biotomy::acquisition {

using bridge::CheckedTable;
using bridge::FlagKey;

namespace {

/// Of what stops the rig when the controller is dead or deaf: more would be no protection.
constexpr int kLongestSilenceMs = 60000;

}  // namespace

SafetyLimits read_safety(const CheckedTable& table) {
  SafetyLimits safety;
  safety.link_lost = duration(table, "link_lost_ms", safety.link_lost,
                              "without an answer of the controller for so long, the rig stops", 1,
                              kLongestSilenceMs);
  safety.controller_silent = duration(
      table, "controller_silent_ms", safety.controller_silent,
      "with the controller's heartbeat unchanged for so long, the rig stops", 1, kLongestSilenceMs);
  safety.require_watchdog = table.get(
      FlagKey{.name = "require_watchdog",
              .fallback = safety.require_watchdog,
              .description = "refuse a controller that does not watch the daemon, or not within "
                             "0.25 to 5 s"});
  safety.position_tolerance = length(table, "position_tolerance_um", safety.position_tolerance,
                                     "an axis further from where it should be stops the rig");
  safety.axis_stall =
      duration(table, "axis_stall_ms", safety.axis_stall,
               "an axis that does not move for so long on its way stops the rig", 100);
  safety.standstill =
      duration(table, "standstill_ms", safety.standstill,
               "a command during which nothing at all moves for so long stops the rig", 100);
  safety.wheel_stands_rpm =
      number(table, "wheel_stands_rpm", safety.wheel_stands_rpm, "rpm", 0.1, 1000.0,
             "a wheel that shows no more counts as standing; three times as much where it must "
             "stand stops the rig");
  safety.spindle_load_maximum_percent =
      number(table, "spindle_load_maximum_percent", safety.spindle_load_maximum_percent, "%", 1.0,
             1000.0, "a higher load of the spindle stops the rig");
  safety.spindle_load_delay = duration(table, "spindle_load_delay_ms", safety.spindle_load_delay,
                                       "above it for so long", 0);
  safety.vibration_maximum_mm_s =
      number(table, "vibration_maximum_mm_s", safety.vibration_maximum_mm_s, "mm/s", 0.01, 1000.0,
             "a stronger vibration of the spindle stops the rig");
  safety.vibration_delay =
      duration(table, "vibration_delay_ms", safety.vibration_delay, "above it for so long", 0);
  safety.block_temperature_minimum_c =
      number(table, "block_temperature_minimum_c", safety.block_temperature_minimum_c, "°C",
             -273.15, 200.0, "a colder block stops the rig");
  safety.block_temperature_maximum_c =
      number(table, "block_temperature_maximum_c", safety.block_temperature_maximum_c, "°C",
             -273.15, 200.0, "a warmer block stops the rig");
  if (safety.block_temperature_minimum_c >= safety.block_temperature_maximum_c) {
    table.reject("block_temperature_minimum_c", "must be below block_temperature_maximum_c");
  }
  safety.temperature_delay = duration(table, "temperature_delay_ms", safety.temperature_delay,
                                      "outside its window for so long", 0);
  safety.temperature_resumes =
      table.get(FlagKey{.name = "temperature_resumes",
                        .fallback = safety.temperature_resumes,
                        .description = "a block outside its window holds the job, which goes on by "
                                       "itself once it is inside; if not, an operator is needed"});
  safety.conditioning_progress_c =
      number(table, "conditioning_progress_c", safety.conditioning_progress_c, "°C", 0.0, 100.0,
             "while the job waits for the block's temperature, it must come nearer by so much");
  safety.conditioning_progress_time =
      duration(table, "conditioning_progress_ms", safety.conditioning_progress_time,
               "within so long, or the rig stops");
  safety.conditioning_limit =
      duration(table, "conditioning_limit_ms", safety.conditioning_limit, "limit of the step");
  safety.disk_reserve_layers =
      count(table, "disk_reserve_layers", safety.disk_reserve_layers, 1, 1000000,
            "with room for fewer layers on the disk, the rig stops");
  safety.disk_for_whole_job = table.get(
      FlagKey{.name = "disk_for_whole_job",
              .fallback = safety.disk_for_whole_job,
              .description = "refuse to begin a job for which the disk has not enough room"});
  safety.disk_resumes =
      table.get(FlagKey{.name = "disk_resumes",
                        .fallback = safety.disk_resumes,
                        .description = "a disk that gets full holds the job, which goes on by "
                                       "itself once there is room; if not, an operator is needed"});
  safety.disk_look = duration(table, "disk_look_ms", safety.disk_look,
                              "while a job is held for it, the disk is asked so often");
  safety.held_limit = duration(table, "held_limit_ms", safety.held_limit,
                               "a job that is held for longer stops with an alarm");
  safety.command_start =
      duration(table, "command_start_ms", safety.command_start,
               "within so long the controller starts a command", 1, kLongestSilenceMs);
  safety.read_back =
      duration(table, "read_back_ms", safety.read_back,
               "so long the command number is read back before an unanswered command counts as "
               "not received");
  safety.command_issues = count(table, "command_issues", safety.command_issues, 1, 100,
                                "a command is handed over so often at most");
  safety.preflight_limit =
      duration(table, "preflight_limit_ms", safety.preflight_limit, "limit of the step");
  safety.recovery_limit =
      duration(table, "recovery_limit_ms", safety.recovery_limit, "limit of the step");
  safety.home_limit = duration(table, "home_limit_ms", safety.home_limit, "limit of the step");
  safety.grind_limit = duration(table, "grind_limit_ms", safety.grind_limit, "limit of the step");
  safety.retract_limit =
      duration(table, "retract_limit_ms", safety.retract_limit, "limit of the step");
  safety.clear_limit =
      duration(table, "clear_limit_ms", safety.clear_limit, "limit of the step, beyond clear_ms");
  safety.focus_limit = duration(table, "focus_limit_ms", safety.focus_limit, "limit of the step");
  safety.capture_limit = duration(table, "capture_limit_ms", safety.capture_limit,
                                  "limit of the step, beyond twice capture_timeout_ms");
  safety.assess_limit =
      duration(table, "assess_limit_ms", safety.assess_limit, "limit of the step");
  safety.store_limit = duration(table, "store_limit_ms", safety.store_limit, "limit of the step");
  safety.park_limit =
      duration(table, "park_limit_ms", safety.park_limit, "limit of stopping and parking the rig");
  safety.reset_limit = duration(table, "reset_limit_ms", safety.reset_limit,
                                "limit of resetting the controller's fault");
  safety.volume_limit =
      duration(table, "volume_limit_ms", safety.volume_limit,
               "at the end of a job, a volume that does not grow for so long is given up");
  return safety;
}

}  // namespace biotomy::acquisition
