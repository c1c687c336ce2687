#include "sim/control/controller.hpp"

#include <algorithm>
#include <utility>

namespace biotomy::sim {

namespace {

constexpr std::chrono::milliseconds kHeartbeatPeriod{40};

/// A swing on arrival at a limit is not yet beyond it.
constexpr double kLimitPlayUm = 50;

bool within(double value, double minimum, double maximum) {
  return value >= minimum && value <= maximum;
}

}  // namespace

Controller::Controller(const ControllerSettings& settings, Mechanics& mechanics,
                       ControllerEvents events)
    : settings_(settings),
      mechanics_(mechanics),
      events_(std::move(events)),
      drives_(settings.drives),
      boot_left_s_(settings.boot_seconds) {}

Acceptance Controller::submit(const Command& command) {
  if (command.sequence <= memory_.sequence_started) {
    return Acceptance::repeated;
  }
  const auto action = static_cast<Action>(command.action);
  if (!powered_ || state_ == ControllerState::booting ||
      (state_ == ControllerState::busy && action != Action::stop)) {
    return Acceptance::busy;
  }
  if (state_ == ControllerState::busy) {
    finish(CommandResult::aborted);
  }
  begin(command);
  return Acceptance::taken;
}

void Controller::begin(const Command& command) {
  command_ = command;
  memory_.sequence_started = command.sequence;
  events_.memory_changed();
  events_.started(command);
  const auto action = static_cast<Action>(command.action);
  if (action == Action::stop) {
    make_safe();
    finish(CommandResult::done);
  } else if (action == Action::reset_fault) {
    finish(reset_fault() ? CommandResult::done : CommandResult::refused);
  } else if (refuses(command)) {
    finish(CommandResult::refused);
  } else {
    plan(command);
    state_ = ControllerState::busy;
  }
}

void Controller::finish(CommandResult result) {
  steps_.clear();
  step_begun_ = false;
  if (state_ == ControllerState::busy) {
    state_ = ControllerState::idle;
  }
  if (result == CommandResult::done) {
    if (static_cast<Action>(command_.action) == Action::grind_pass) {
      ++memory_.grind_count;
      memory_.ground_position_um = std::max(memory_.ground_position_um, command_.position_um);
    } else if (static_cast<Action>(command_.action) == Action::home) {
      set_homed(true);
    }
  }
  memory_.sequence_finished = command_.sequence;
  memory_.result = result;
  events_.memory_changed();
  events_.finished(command_, result);
}

bool Controller::refuses(const Command& command) const {
  if (state_ == ControllerState::faulted || inputs_.estop_pressed || inputs_.door_open) {
    return true;
  }
  switch (static_cast<Action>(command.action)) {
    case Action::grind_pass:
      return !homed_ || command.spindle_rpm <= 0.0 ||
             command.spindle_rpm > settings_.spindle_maximum_rpm ||
             !within(command.position_um, settings_.feed_minimum_um, settings_.feed_maximum_um);
    case Action::move_column:
      return !homed_ ||
             !within(command.position_um, settings_.column_minimum_um, settings_.column_maximum_um);
    case Action::home:
    case Action::retract:
    case Action::clear_face:
    case Action::stop:
    case Action::reset_fault:
      return false;
  }
  return true;
}

void Controller::hear_master(std::uint16_t heartbeat) {
  if (!master_known_ || heartbeat != master_heartbeat_) {
    master_known_ = true;
    master_heard_ = true;
    master_heartbeat_ = heartbeat;
  }
}

void Controller::set_inputs(const SafetyInputs& inputs) {
  inputs_ = inputs;
  if (!powered_ || state_ == ControllerState::booting) {
    return;
  }
  if (inputs_.estop_pressed) {
    fall_into(Fault::estop);
  } else if (inputs_.door_open) {
    fall_into(Fault::door);
  }
}

void Controller::advance(double rig_seconds, RealTime now) {
  if (!powered_) {
    return;
  }
  if (now - heartbeat_at_ >= kHeartbeatPeriod && !heartbeat_stopped_) {
    ++heartbeat_;
    heartbeat_at_ = now;
  }
  if (state_ == ControllerState::booting) {
    boot_left_s_ -= rig_seconds;
    if (boot_left_s_ <= 0.0) {
      state_ = ControllerState::idle;
      set_inputs(inputs_);
    }
  }
  watch(now);
  guard(rig_seconds);
  if (state_ == ControllerState::busy) {
    carry_on(rig_seconds);
  }
}

void Controller::watch(RealTime now) {
  if (std::exchange(master_heard_, false)) {
    master_heard_at_ = now;
  }
  master_silent_ = master_known_ && settings_.watchdog_timeout.count() > 0 &&
                   now - master_heard_at_ >= settings_.watchdog_timeout;
  if (master_silent_ && state_ != ControllerState::booting && !watchdog_tripped_) {
    watchdog_tripped_ = true;
    fall_into(Fault::watchdog);
  }
}

bool Controller::beyond_limits() const {
  const auto beyond = [](const Axis& axis, double minimum, double maximum) {
    return !within(axis.position_um(), minimum - kLimitPlayUm, maximum + kLimitPlayUm);
  };
  return beyond(mechanics_.feed, settings_.feed_minimum_um, settings_.feed_maximum_um) ||
         beyond(mechanics_.column, settings_.column_minimum_um, settings_.column_maximum_um) ||
         beyond(mechanics_.traverse, traverse_minimum_um(), traverse_maximum_um());
}

Fault Controller::machine_fault() const {
  return beyond_limits()        ? Fault::limit
         : drives_.disobeyed()  ? Fault::drive
         : drives_.overloaded() ? Fault::spindle_overload
                                : Fault::none;
}

void Controller::guard(double rig_seconds) {
  if (state_ == ControllerState::booting) {
    return;
  }
  drives_.watch(mechanics_, rig_seconds);
  const Fault fault = machine_fault();
  if (fault != Fault::none) {
    fall_into(fault);
  }
  if (state_ == ControllerState::faulted) {
    let_go();
  }
}

/// Drives are off while faulted, but for lifting the wheel: an axis at rest is where it is. Once
/// nobody can be hurt, one beyond its limits is brought back to them.
void Controller::let_go() {
  const bool may_move = !inputs_.estop_pressed && !inputs_.door_open;
  const auto treat = [&](Axis& axis, double minimum, double maximum, double speed_um_s) {
    if (!axis.arrived()) {
      return;
    }
    if (may_move && !within(axis.position_um(), minimum, maximum)) {
      axis.go_to(std::clamp(axis.position_um(), minimum, maximum), speed_um_s);
    } else {
      axis.halt();
    }
  };
  const MechanicsSettings& machine = mechanics_.settings();
  treat(mechanics_.feed, settings_.feed_minimum_um, settings_.feed_maximum_um,
        machine.feed.speed_um_s);
  treat(mechanics_.column, settings_.column_minimum_um, settings_.column_maximum_um,
        machine.column.speed_um_s);
  treat(mechanics_.traverse, traverse_minimum_um(), traverse_maximum_um(),
        machine.traverse.speed_um_s);
}

void Controller::carry_on(double rig_seconds) {
  if (step_begun_) {
    waited_ms_ += 1e3 * rig_seconds;
  }
  while (!steps_.empty()) {
    if (!std::exchange(step_begun_, true)) {
      waited_ms_ = 0;
      steps_.front().begin();
    }
    if (!steps_.front().ended()) {
      return;
    }
    steps_.pop_front();
    step_begun_ = false;
  }
  finish(CommandResult::done);
}

void Controller::fall_into(Fault fault) {
  if (state_ == ControllerState::faulted) {
    return;  // the first cause is the one to be told
  }
  const bool interrupted = state_ == ControllerState::busy;
  make_safe();
  mechanics_.feed.go_to(lifted(mechanics_.feed.position_um()),
                        mechanics_.settings().feed.speed_um_s);
  fault_ = fault;
  events_.faulted(fault);
  if (interrupted) {
    finish(CommandResult::aborted);
  }
  state_ = ControllerState::faulted;
}

bool Controller::reset_fault() {
  if (inputs_.estop_pressed || inputs_.door_open || master_silent_ ||
      machine_fault() != Fault::none) {
    return false;
  }
  if (state_ == ControllerState::faulted) {
    state_ = ControllerState::idle;
    fault_ = Fault::none;
    watchdog_tripped_ = false;
    events_.reset();
  }
  return true;
}

void Controller::make_safe() {
  mechanics_.turn_spindle(0);
  mechanics_.blow_air(false);
  mechanics_.flow_coolant(false);
  mechanics_.feed.halt();
  mechanics_.traverse.halt();
  mechanics_.column.halt();
}

void Controller::set_homed(bool homed) {
  if (std::exchange(homed_, homed) != homed) {
    events_.homed(homed);
  }
}

void Controller::set_power(bool on) {
  if (std::exchange(powered_, on) == on) {
    return;
  }
  if (!on) {
    make_safe();  // contactors and valves fall off
    return;
  }
  const bool interrupted = state_ == ControllerState::busy;
  state_ = ControllerState::booting;
  boot_left_s_ = settings_.boot_seconds;
  fault_ = Fault::none;
  drives_ = DriveMonitor(settings_.drives);
  heartbeat_ = 0;
  master_known_ = false;
  master_heard_ = false;
  master_silent_ = false;
  watchdog_tripped_ = false;
  set_homed(false);
  if (interrupted) {
    finish(CommandResult::aborted);
  }
}

ControllerStatus Controller::status() const {
  return {state_, fault_,    inputs_.estop_pressed, inputs_.door_open, watchdog_tripped_,
          homed_, heartbeat_};
}

void Controller::restore(const ControllerMemory& memory) {
  memory_ = memory;
  if (memory_.sequence_finished != memory_.sequence_started) {
    memory_.sequence_finished = memory_.sequence_started;
    memory_.result = CommandResult::aborted;
  }
}

}  // namespace biotomy::sim
