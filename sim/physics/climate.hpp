#pragma once

namespace biotomy::sim {

struct ClimateSettings {
  double chamber_c = -22;            ///< what the cooler keeps
  double chamber_band_c = 0;         ///< it switches so far above and below
  double ambient_c = 20;             ///< outside
  double insulation_s = 1800;        ///< time constant towards the ambient without the cooler
  double cooling_c_s = 0.06;         ///< what the cooler takes out of the chamber
  double block_below_chamber_c = 8;  ///< the holder's own cold plate
  double block_s = 60;               ///< time constant of the block
  double grinding_c_s = 0.02;        ///< by which the wheel warms the block while it cuts
};

/// The temperatures: a chamber whose cooler goes on and off, and a block that follows it and is
/// warmed by the wheel. Degrees Celsius and seconds of the rig.
class Climate {
 public:
  explicit Climate(const ClimateSettings& settings);

  /// `failed_s` is the time constant with which the chamber warms with its cooler and the holder's
  /// cold plate dead; 0: they work.
  void advance(double seconds, bool wheel_cuts, double failed_s);

  double block_c() const { return block_c_; }
  double chamber_c() const { return chamber_c_; }

 private:
  ClimateSettings settings_;
  double chamber_c_;
  double block_c_;
  bool cooler_on_ = false;
};

}  // namespace biotomy::sim
