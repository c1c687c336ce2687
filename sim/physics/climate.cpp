#include "sim/physics/climate.hpp"

#include <algorithm>

namespace biotomy::sim {

namespace {

/// How far a quantity comes in `seconds` on its way over `distance`.
double relaxed(double distance, double seconds, double time_constant_s) {
  return distance * std::min(1.0, seconds / time_constant_s);
}

}  // namespace

Climate::Climate(const ClimateSettings& settings)
    : settings_(settings),
      chamber_c_(settings.chamber_c),
      block_c_(settings.chamber_c - settings.block_below_chamber_c) {}

void Climate::advance(double seconds, bool wheel_cuts, double failed_s) {
  const bool failed = failed_s > 0.0;
  if (chamber_c_ >= settings_.chamber_c + settings_.chamber_band_c) {
    cooler_on_ = true;
  } else if (chamber_c_ <= settings_.chamber_c - settings_.chamber_band_c) {
    cooler_on_ = false;
  }
  chamber_c_ += relaxed(settings_.ambient_c - chamber_c_, seconds,
                        failed ? failed_s : settings_.insulation_s);
  if (cooler_on_ && !failed) {
    chamber_c_ = std::max(chamber_c_ - settings_.cooling_c_s * seconds,
                          settings_.chamber_c - settings_.chamber_band_c);
  }
  const double plate_c = chamber_c_ - (failed ? 0.0 : settings_.block_below_chamber_c);
  block_c_ += relaxed(plate_c - block_c_, seconds, settings_.block_s) +
              (wheel_cuts ? settings_.grinding_c_s * seconds : 0.0);
}

}  // namespace biotomy::sim
