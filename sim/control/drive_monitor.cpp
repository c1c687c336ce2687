#include "sim/control/drive_monitor.hpp"

#include <cmath>
#include <utility>

namespace biotomy::sim {

void DriveMonitor::Follower::watch(double value, bool wrong_at_rest, bool under_way,
                                   double seconds) {
  const bool still = std::exchange(seen, value) == value;
  wrong_s = wrong_at_rest || (under_way && still) ? wrong_s + seconds : 0.0;
}

void DriveMonitor::watch(Follower& follower, const Axis& axis, double seconds) const {
  const bool astray = axis.arrived() &&
                      std::fabs(axis.position_um() - axis.target_um()) > limits_.following_error_um;
  follower.watch(axis.position_um(), astray, !axis.arrived(), seconds);
}

void DriveMonitor::watch(const Mechanics& mechanics, double seconds) {
  watch(feed_, mechanics.feed, seconds);
  watch(traverse_, mechanics.traverse, seconds);
  watch(column_, mechanics.column, seconds);
  spindle_.watch(mechanics.spindle_rpm(), false, !mechanics.spindle_settled(), seconds);
  overloaded_s_ =
      mechanics.spindle_load_percent() > limits_.overload_percent ? overloaded_s_ + seconds : 0.0;
}

bool DriveMonitor::disobeyed() const {
  for (const Follower* follower : {&feed_, &traverse_, &column_, &spindle_}) {
    if (follower->wrong_s > limits_.still_s) {
      return true;
    }
  }
  return false;
}

}  // namespace biotomy::sim
