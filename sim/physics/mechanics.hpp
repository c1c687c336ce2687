#pragma once

#include "sim/physics/axis.hpp"
#include "sim/physics/block.hpp"
#include "sim/physics/climate.hpp"
#include "sim/physics/machine_defects.hpp"

namespace biotomy::sim {

/// An ideal machine by default: no play, no swing, a wheel that does not wear.
struct MechanicsSettings {
  AxisSettings feed{.speed_um_s = 2000};
  AxisSettings traverse{.speed_um_s = 60000};  ///< on the way to the wheel and back
  AxisSettings column{.speed_um_s = 4000};
  double grinding_speed_um_s = 6000;  ///< of the traverse, under the wheel
  double wheel_at_um = 150000;        ///< traverse position at which the wheel meets the face
  double face_width_um = 10000;
  double face_height_um = 10000;
  double spindle_acceleration_rpm_s = 3000;
  double vibration_decay_s = 0;  ///< time constant, once what shook the machine is over
  double wheel_wear_um_mm3 = 0;  ///< radius lost for each cubic millimetre ground away
  double load_per_wear_um = 0;   ///< share of the cutting load that a micrometre of wear adds
  ClimateSettings climate{};
};

/// The machine without its controller: three axes, a spindle, an air nozzle, the block. It does
/// what physics does with the targets it is given and knows no commands: if the turning wheel is
/// deeper than the face while the block passes under it, the face is ground, to the feed position
/// less what the wheel has worn.
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

  /// What is broken from now on.
  void set_defects(const MachineDefects& defects);

  double spindle_rpm() const { return spindle_rpm_; }
  double spindle_target_rpm() const { return spindle_target_rpm_; }
  bool spindle_settled() const { return spindle_rpm_ == spindle_target_rpm_; }

  /// Of the rated torque; more than 100 is more than it should bear. Grows with the depth of the
  /// cut, the speed of the block under the wheel, and wear.
  double spindle_load_percent() const;
  double vibration_mm_s() const { return vibration_mm_s_; }
  double block_temperature_c() const { return climate_.block_c(); }
  double chamber_temperature_c() const { return climate_.chamber_c(); }
  bool air_on() const { return air_on_; }
  bool coolant_on() const { return coolant_on_; }
  bool cutting() const { return cut_depth_um_ > 0.0; }

  /// What the wheel's radius has lost.
  double wheel_worn_um() const { return wheel_worn_um_; }

  /// Traverse positions between which the wheel goes over the whole face.
  double face_begin_um() const { return settings_.wheel_at_um; }
  double face_end_um() const { return settings_.wheel_at_um + settings_.face_width_um; }

  const MechanicsSettings& settings() const { return settings_; }
  const Block& block() const { return block_; }

  /// The machine as it stood, its motors at these positions; the spindle stands.
  struct State {
    Block::State block;
    double feed_um = 0;
    double traverse_um = 0;
    double column_um = 0;
    double wheel_worn_um = 0;
  };
  State state() const;
  void restore(const State& state);

 private:
  void spin(double seconds);
  void shake(double seconds);
  void grind(double traverse_before_um);

  MechanicsSettings settings_;
  MachineDefects defects_;
  Block block_;
  Climate climate_;
  double spindle_rpm_ = 0;
  double spindle_target_rpm_ = 0;
  double cut_depth_um_ = 0;         ///< what the wheel takes off just now
  double traverse_speed_um_s_ = 0;  ///< of the block just now
  double vibration_mm_s_ = 0;
  double wheel_worn_um_ = 0;
  bool air_on_ = false;
  bool coolant_on_ = false;
};

}  // namespace biotomy::sim
