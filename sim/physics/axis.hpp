#pragma once

namespace biotomy::sim {

/// How far an axis is from an ideal one, which it is by default.
struct AxisSettings {
  double speed_um_s = 2000;
  double backlash_um = 0;   ///< play between the motor and what it moves
  double overshoot_um = 0;  ///< beyond the target, on arrival
  double settling_s = 0;    ///< from reaching the target to standing still on it
};

/// What may be broken in an axis.
struct AxisDefects {
  bool stalled = false;      ///< the motor turns no more, whatever it is told
  double creep_um_s = 0;     ///< it gives way while it should stand; signed
  double read_error_um = 0;  ///< its scale shows so much more than is true
};

/// A positioned axis: it goes to its target at no more than its speed, swings beyond it, and has
/// arrived once it stands still. Micrometres and seconds; time passes by advance() alone.
/// The scale sits on the motor. What the motor moves follows without play when the motor goes up,
/// and by the backlash later when it comes down.
class Axis {
 public:
  explicit Axis(const AxisSettings& settings, double position_um = 0.0);

  void go_to(double target_um, double speed_um_s);

  /// Stands still at once, wherever it is.
  void halt();

  void advance(double seconds);

  void set_defects(const AxisDefects& defects) { defects_ = defects; }

  /// What the scale shows.
  double position_um() const { return swung_um() + defects_.read_error_um; }

  /// What the scale would show if it told the truth.
  double motor_um() const { return swung_um(); }

  /// Where the part is that the axis moves.
  double mechanical_um() const { return mechanical_um_; }

  double target_um() const { return target_um_; }

  /// Standing still where it was told to go, as far as its drive knows.
  bool arrived() const { return arrived_; }

 private:
  double swung_um() const { return motor_um_ + swing_um_; }

  AxisSettings settings_;
  AxisDefects defects_;
  double motor_um_;
  double swing_um_ = 0;
  double mechanical_um_;
  double target_um_;
  double speed_um_s_;
  double direction_ = 1;    ///< of the present motion
  double at_target_s_ = 0;  ///< how long it has been settling
  bool arrived_ = true;
};

}  // namespace biotomy::sim
