#pragma once

#include <chrono>

#include "firmware_bridge/micrometres.hpp"

namespace biotomy::acquisition {

/// Beyond these the wheel stops. Every wait of the job has its limit here.
struct SafetyLimits {
  std::chrono::milliseconds link_lost{1500};          ///< without one good exchange
  std::chrono::milliseconds controller_silent{1000};  ///< its heartbeat unchanged
  bool require_watchdog = true;  ///< refuse a controller that does not watch the daemon well
  bridge::Micrometres position_tolerance{5.0};
  std::chrono::milliseconds axis_stall{3000};   ///< an axis that is not at its target, unmoved
  std::chrono::milliseconds standstill{30000};  ///< a command under way, and nothing moves at all
  double wheel_stands_rpm = 5.0;                ///< an encoder at rest may show as much
  std::chrono::milliseconds wheel_delay{500};   ///< where it must stand, it turns for so long
  double spindle_load_maximum_percent = 95.0;
  std::chrono::milliseconds spindle_load_delay{1000};  ///< above it for so long
  /// Beyond it, vibration of a medium-sized machine is harmful (ISO 10816-1, annex B, class II).
  double vibration_maximum_mm_s = 7.1;
  std::chrono::milliseconds vibration_delay{1000};  ///< above it for so long

  double block_temperature_minimum_c = -80.0;
  double block_temperature_maximum_c = -5.0;
  std::chrono::milliseconds temperature_delay{5000};  ///< outside the window for so long
  bool temperature_resumes = false;  ///< go on by itself once the block is in its window again
  /// While waiting for the block's temperature, it must come nearer to its window by so much …
  double conditioning_progress_c = 0.2;
  std::chrono::milliseconds conditioning_progress_time{600000};  ///< … within so long
  std::chrono::milliseconds conditioning_limit{14400000};

  int disk_reserve_layers = 20;
  bool disk_for_whole_job = true;             ///< refuse to begin what the disk has no room to end
  bool disk_resumes = false;                  ///< go on by itself once there is room again
  std::chrono::milliseconds disk_look{5000};  ///< while held for it, the disk is asked so often
  std::chrono::milliseconds held_limit{43200000};

  std::chrono::milliseconds command_start{2000};  ///< from handing over to `sequence_started`
  std::chrono::milliseconds read_back{500};  ///< watched before a command counts as not received
  int command_issues = 10;                   ///< a command is handed over so often at most

  std::chrono::milliseconds preflight_limit{60000};
  std::chrono::milliseconds recovery_limit{60000};
  std::chrono::milliseconds home_limit{120000};
  std::chrono::milliseconds grind_limit{300000};
  std::chrono::milliseconds retract_limit{60000};
  std::chrono::milliseconds clear_limit{60000};  ///< beyond the duration of the air blast
  std::chrono::milliseconds focus_limit{600000};
  std::chrono::milliseconds capture_limit{60000};
  std::chrono::milliseconds assess_limit{60000};
  std::chrono::milliseconds store_limit{600000};
  std::chrono::milliseconds park_limit{120000};
  std::chrono::milliseconds reset_limit{10000};
  std::chrono::milliseconds volume_limit{
      600000};  ///< without a new layer in the volume, at the end
};

}  // namespace biotomy::acquisition
