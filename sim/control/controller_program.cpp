// What the controller does for each command, step by step.

#include <algorithm>

#include "sim/control/controller.hpp"

namespace biotomy::sim {

namespace {

/// The block passes beyond the wheel's edge by so much on either side.
constexpr double kRunOutUm = 2000;

}  // namespace

double Controller::lifted(double feed_um) const {
  return std::max(settings_.feed_minimum_um, feed_um - settings_.lift_um);
}

double Controller::traverse_maximum_um() const {
  return mechanics_.face_end_um() + kRunOutUm;
}

Controller::Step Controller::move(Axis& axis, double target_um, double speed_um_s) const {
  return {[&axis, target_um, speed_um_s] { axis.go_to(target_um, speed_um_s); },
          [&axis] { return axis.arrived(); }};
}

Controller::Step Controller::spin(double rpm) const {
  return {[this, rpm] { mechanics_.turn_spindle(rpm); },
          [this] { return mechanics_.spindle_settled(); }};
}

void Controller::plan(const Command& command) {
  switch (static_cast<Action>(command.action)) {
    case Action::home:
      return plan_home();
    case Action::grind_pass:
      return plan_grind_pass(command);
    case Action::retract:
      return plan_retract();
    case Action::move_column:
      steps_.push_back(
          move(mechanics_.column, command.position_um, mechanics_.settings().column.speed_um_s));
      return;
    case Action::clear_face:
      steps_.push_back({[this] { mechanics_.blow_air(true); },
                        [this, command] { return waited_ms_ >= command.duration_ms; }});
      steps_.push_back({[this] { mechanics_.blow_air(false); }, [] { return true; }});
      return;
    case Action::stop:
    case Action::reset_fault:
      return;  // done at once, without steps
  }
}

void Controller::plan_home() {
  const MechanicsSettings& machine = mechanics_.settings();
  steps_.push_back(spin(0));
  steps_.push_back(move(mechanics_.feed, settings_.feed_minimum_um, machine.feed.speed_um_s));
  steps_.push_back(move(mechanics_.traverse, traverse_minimum_um(), machine.traverse.speed_um_s));
  steps_.push_back(move(mechanics_.column, settings_.column_minimum_um, machine.column.speed_um_s));
}

void Controller::plan_grind_pass(const Command& command) {
  const MechanicsSettings& machine = mechanics_.settings();
  const double above_um = std::min(mechanics_.feed.position_um(), lifted(command.position_um));
  steps_.push_back(move(mechanics_.feed, above_um, machine.feed.speed_um_s));
  steps_.push_back(spin(command.spindle_rpm));
  steps_.push_back(move(mechanics_.traverse, mechanics_.face_begin_um() - kRunOutUm,
                        machine.traverse.speed_um_s));
  steps_.push_back({[this] { mechanics_.flow_coolant(true); }, [] { return true; }});
  steps_.push_back(move(mechanics_.feed, command.position_um, machine.feed.speed_um_s));
  steps_.push_back(move(mechanics_.traverse, traverse_maximum_um(), machine.grinding_speed_um_s));
  steps_.push_back({[this] { mechanics_.flow_coolant(false); }, [] { return true; }});
}

void Controller::plan_retract() {
  const MechanicsSettings& machine = mechanics_.settings();
  steps_.push_back({[this, &machine] {
                      mechanics_.turn_spindle(0);
                      mechanics_.feed.go_to(lifted(mechanics_.feed.position_um()),
                                            machine.feed.speed_um_s);
                    },
                    [this] { return mechanics_.feed.arrived(); }});
  steps_.push_back(move(mechanics_.traverse, traverse_minimum_um(), machine.traverse.speed_um_s));
  steps_.push_back(spin(0));
}

}  // namespace biotomy::sim
