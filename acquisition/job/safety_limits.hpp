#pragma once

#include <chrono>

#include "firmware_bridge/micrometres.hpp"

namespace biotomy::acquisition {

/// Beyond these the wheel stops. Every wait of the job has its limit here.
struct SafetyLimits {
  std::chrono::milliseconds link_lost{1500};          ///< without one good exchange
  std::chrono::milliseconds controller_silent{1000};  ///< its heartbeat unchanged
  bool require_watchdog = true;  ///< refuse a controller that does not watch the daemon
  bridge::Micrometres position_tolerance{5.0};
  double block_temperature_minimum_c = -80.0;
  double block_temperature_maximum_c = -5.0;
  std::chrono::milliseconds temperature_delay{5000};  ///< outside the window for so long
  int disk_reserve_layers = 20;

  std::chrono::milliseconds command_start{2000};  ///< from handing over to `sequence_started`
  std::chrono::milliseconds read_back{500};  ///< watched before a command counts as not received
  int command_issues = 3;                    ///< a command is handed over so often at most

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
