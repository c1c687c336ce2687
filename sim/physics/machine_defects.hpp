#pragma once

#include "sim/physics/axis.hpp"

namespace biotomy::sim {

/// What may be broken in the machine: knobs, none of which is turned by default.
struct MachineDefects {
  AxisDefects feed{};
  AxisDefects traverse{};
  AxisDefects column{};
  double wheel_short_um = 0;        ///< the wheel reaches so much less deep than the feed says
  double extra_load_percent = 0;    ///< on the spindle while it turns
  bool spindle_blocked = false;     ///< no torque: it runs down, or doesn't start
  bool spindle_runs_on = false;     ///< once it turns, it keeps its speed
  bool air_blocked = false;         ///< the blast reaches no debris
  double extra_vibration_mm_s = 0;  ///< whatever the spindle does
  double cooler_failed_s = 0;       ///< time constant with which the chamber warms; 0: none failed
};

}  // namespace biotomy::sim
