#pragma once

#include "sim/physics/axis.hpp"
#include "sim/physics/block.hpp"

namespace biotomy::sim {

struct MechanicsSettings {
  double feed_speed_um_s = 2000;
  double traverse_speed_um_s = 60000;  ///< on the way to the wheel and back
  double grinding_speed_um_s = 6000;   ///< under the wheel
  double column_speed_um_s = 4000;
  double wheel_at_um = 150000;  ///< traverse position at which the wheel meets the face
  double face_width_um = 10000;
  double spindle_acceleration_rpm_s = 3000;
  double block_temperature_c = -30;
  double chamber_temperature_c = -22;
};

/// The machine without its controller: three axes, a spindle, an air nozzle, the block. It does
/// what physics does with the targets it is given and knows no commands: if the turning wheel is
/// deeper than the face while the block passes under it, the face is ground.
/// Time passes by advance() alone, in seconds of the rig.
class Mechanics {
 public:
  Mechanics(const MechanicsSettings& settings, const Block& block);

  void advance(double seconds);

  Axis feed;      ///< of the wheel, growing into the block
  Axis traverse;  ///< of the block; 0 is parked under the camera
  Axis column;    ///< of the camera, growing towards the block
  void turn_spindle(double rpm) { spindle_target_rpm_ = rpm; }
  void blow_air(bool on) { air_on_ = on; }
  void flow_coolant(bool on) { coolant_on_ = on; }

  double spindle_rpm() const { return spindle_rpm_; }
  bool spindle_settled() const { return spindle_rpm_ == spindle_target_rpm_; }
  double spindle_load_percent() const;
  double vibration_mm_s() const;
  double block_temperature_c() const { return block_temperature_c_; }
  double chamber_temperature_c() const { return settings_.chamber_temperature_c; }
  bool air_on() const { return air_on_; }
  bool coolant_on() const { return coolant_on_; }
  bool cutting() const { return cut_depth_um_ > 0.0; }

  /// Traverse positions between which the wheel goes over the whole face.
  double face_begin_um() const { return settings_.wheel_at_um; }
  double face_end_um() const { return settings_.wheel_at_um + settings_.face_width_um; }

  const MechanicsSettings& settings() const { return settings_; }
  const Block& block() const { return block_; }
  void restore(const Block::State& block, double feed_um, double traverse_um, double column_um);

 private:
  void grind(double traverse_before_um);

  MechanicsSettings settings_;
  Block block_;
  double spindle_rpm_ = 0;
  double spindle_target_rpm_ = 0;
  double cut_depth_um_ = 0;  ///< what the wheel takes off just now
  double block_temperature_c_;
  bool air_on_ = false;
  bool coolant_on_ = false;
};

}  // namespace biotomy::sim
