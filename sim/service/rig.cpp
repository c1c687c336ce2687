#include "sim/service/rig.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace biotomy::sim {

namespace {

constexpr double kStepSeconds = 0.004;

/// While the machine moves, its axes are kept so often that a killed twin forgets little. What is
/// ground off is kept at once.
constexpr std::chrono::milliseconds kKeepingPeriod{250};

const char* name_of(bridge::RigInput input) {
  return input == bridge::RigInput::estop ? "estop" : "door";
}

const char* name_of(bridge::RigOutput output) {
  switch (output) {
    case bridge::RigOutput::lamp:
      return "lamp";
    case bridge::RigOutput::trigger:
      return "trigger";
    case bridge::RigOutput::tower_light:
      return "tower_light";
  }
  return "unknown";
}

}  // namespace

Rig::Rig(const RigSettings& settings, StateFile state_file, WitnessLog& witness, RealTime now)
    : settings_(settings),
      state_file_(std::move(state_file)),
      witness_(witness),
      mechanics_(settings.mechanics, Block(settings.seed, settings.initial_face_um,
                                           settings.roughness_um, settings.debris)),
      controller_(settings.controller, mechanics_, events()),
      schedule_(settings.scenario, settings.seed, schedule_events()),
      block_before_(mechanics_.block()),
      now_(now),
      state_written_at_(now) {
  if (const std::optional<RigState> state = state_file_.read()) {
    mechanics_.restore(state->machine);
    block_before_ = mechanics_.block();
    controller_.restore(state->memory);
  } else {
    // A rig is delivered with its axes at home.
    mechanics_.restore({.block = mechanics_.block().state(),
                        .feed_um = settings.controller.feed_minimum_um,
                        .column_um = settings.controller.column_minimum_um});
  }
  write_state();
  witness_.twin_started(rig_s_, settings_.seed, controller_.memory(), mechanics_.block());
  schedule_.advance(rig_s_, now_);
  follow_schedule();
}

ControllerEvents Rig::events() {
  return {.started =
              [this](const Command& command) {
                block_before_ = mechanics_.block();
                witness_.command_started(rig_s_, command);
              },
          .finished = [this](const Command& command,
                             CommandResult result) { finish_command(command, result); },
          .faulted = [this](Fault fault) { witness_.faulted(rig_s_, fault); },
          .reset = [this] { witness_.fault_reset(rig_s_); },
          .homed = [this](bool homed) { witness_.homed(rig_s_, homed); },
          .memory_changed = [this] { write_state(); }};
}

ScheduleEvents Rig::schedule_events() {
  return {.began = [this](const ScenarioEvent& event) { witness_.fault_began(rig_s_, event); },
          .ended = [this](const ScenarioEvent& event) { witness_.fault_ended(rig_s_, event); }};
}

void Rig::finish_command(const Command& command, CommandResult result) {
  const bool done = result == CommandResult::done;
  const bool grinds = static_cast<Action>(command.action) == Action::grind_pass;
  const Block& block = mechanics_.block();
  if (grinds && (done || block.state().passes != block_before_.state().passes)) {
    witness_.grind_pass(rig_s_, command, result, block_before_, block, mechanics_.wheel_worn_um());
  }
  witness_.command_finished(rig_s_, command, result);
  if (grinds && result != CommandResult::refused) {
    schedule_.grind_ended(controller_.memory().grind_count + (done ? 0 : 1), done);
  }
}

/// Turns the knobs of the rig's parts as the faults that last want it.
void Rig::follow_schedule() {
  if (is_sound_ && schedule_.active().empty()) {
    return;
  }
  is_sound_ = schedule_.active().empty();
  condition_ = condition_of(schedule_.active(), rig_s_);
  mechanics_.set_defects(condition_.machine);
  controller_.stop_heartbeat(condition_.controller_heartbeat_stopped);
  if (controller_.powered() != condition_.controller_powered) {
    witness_.controller_power(rig_s_, condition_.controller_powered);
    controller_.set_power(condition_.controller_powered);
  }
  follow_inputs();
}

void Rig::follow_inputs() {
  const auto follow = [&](bool& input, bool on, bridge::RigInput which) {
    if (std::exchange(input, on) != on) {
      witness_.input_changed(rig_s_, name_of(which), on);
    }
  };
  follow(inputs_.estop_pressed, bench_inputs_.estop_pressed || condition_.estop_pressed,
         bridge::RigInput::estop);
  follow(inputs_.door_open, bench_inputs_.door_open || condition_.door_open,
         bridge::RigInput::door);
  controller_.set_inputs(inputs_);
}

void Rig::watch_spindle() {
  if (mechanics_.spindle_target_rpm() > 0.0) {
    spindle_released_s_.reset();
  } else if (!spindle_released_s_) {
    spindle_released_s_ = rig_s_;
  }
  const bool turns = mechanics_.spindle_rpm() > 0.0;
  if (std::exchange(spindle_turns_, turns) == turns) {
    return;
  }
  if (turns) {
    spindle_started_s_ = rig_s_;
    witness_.spindle_started(rig_s_, mechanics_.spindle_target_rpm());
  } else {
    witness_.spindle_stopped(rig_s_, rig_s_ - spindle_started_s_,
                             rig_s_ - spindle_released_s_.value_or(rig_s_));
  }
}

void Rig::advance(RealTime now) {
  const std::lock_guard lock(mutex_);
  double left_s = settings_.time_scale * std::chrono::duration<double>(now - now_).count();
  now_ = now;
  while (left_s > 0.0) {
    const double step_s = std::min(left_s, kStepSeconds);
    left_s -= step_s;
    rig_s_ += step_s;
    schedule_.advance(rig_s_, now);
    follow_schedule();
    mechanics_.advance(step_s);
    watch_spindle();
    controller_.advance(step_s, now);
  }
  const bool moves = controller_.status().state == ControllerState::busy;
  if (was_ground() || (moves && now - state_written_at_ >= kKeepingPeriod)) {
    write_state();
  }
}

void Rig::keep_state() {
  const std::lock_guard lock(mutex_);
  write_state();
}

void Rig::write_state() {
  state_file_.write({controller_.memory(), mechanics_.state()});
  state_written_at_ = now_;
  block_kept_ = mechanics_.block().state();
}

bool Rig::was_ground() const {
  const Block::State& block = mechanics_.block().state();
  return block.passes != block_kept_.passes || block.strip_depth_um != block_kept_.strip_depth_um;
}

ControllerReading Rig::read() {
  const std::lock_guard lock(mutex_);
  return {.status = controller_.status(),
          .memory = controller_.memory(),
          .settings = controller_.settings(),
          .feed_um = mechanics_.feed.position_um(),
          .traverse_um = mechanics_.traverse.position_um(),
          .column_um = mechanics_.column.position_um(),
          .feed_target_um = mechanics_.feed.target_um(),
          .traverse_target_um = mechanics_.traverse.target_um(),
          .column_target_um = mechanics_.column.target_um(),
          .traverse_minimum_um = controller_.traverse_minimum_um(),
          .traverse_maximum_um = controller_.traverse_maximum_um(),
          .spindle_rpm = mechanics_.spindle_rpm(),
          .spindle_load_percent = mechanics_.spindle_load_percent(),
          .vibration_mm_s = mechanics_.vibration_mm_s(),
          .block_temperature_c = mechanics_.block_temperature_c(),
          .chamber_temperature_c = mechanics_.chamber_temperature_c(),
          .coolant_on = mechanics_.coolant_on(),
          .air_on = mechanics_.air_on()};
}

void Rig::hear_master(std::uint16_t heartbeat) {
  const std::lock_guard lock(mutex_);
  controller_.hear_master(heartbeat);
}

Acceptance Rig::submit(const Command& command) {
  const std::lock_guard lock(mutex_);
  const auto action = static_cast<Action>(command.action);
  if (action == Action::reset_fault && command.sequence != controller_.memory().sequence_started) {
    schedule_.reset_given();
    follow_schedule();
  }
  const Acceptance acceptance = controller_.submit(command);
  if (acceptance == Acceptance::taken && action == Action::grind_pass &&
      controller_.status().state == ControllerState::busy) {
    schedule_.grind_started(controller_.memory().grind_count + 1);
  }
  return acceptance;
}

bool Rig::answers() const {
  const std::lock_guard lock(mutex_);
  return controller_.powered() && !condition_.modbus_silent;
}

SafetyInputs Rig::inputs() const {
  const std::lock_guard lock(mutex_);
  return inputs_;
}

void Rig::set_input(bridge::RigInput input, bool on) {
  const std::lock_guard lock(mutex_);
  (input == bridge::RigInput::estop ? bench_inputs_.estop_pressed : bench_inputs_.door_open) = on;
  follow_inputs();
}

void Rig::add_event(const ScenarioEvent& event) {
  const std::lock_guard lock(mutex_);
  schedule_.add(event);
  follow_schedule();
}

bool Rig::end_event(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const bool known = schedule_.remove(name);
  follow_schedule();
  return known;
}

void Rig::set_output(bridge::RigOutput output, bool on) {
  const std::lock_guard lock(mutex_);
  bool& state = output == bridge::RigOutput::lamp      ? lamp_on_
                : output == bridge::RigOutput::trigger ? trigger_on_
                                                       : tower_light_on_;
  if (std::exchange(state, on) != on) {
    witness_.output_changed(rig_s_, name_of(output), on);
  }
}

Scene Rig::scene() const {
  const std::lock_guard lock(mutex_);
  return {mechanics_.block(),
          mechanics_.traverse.mechanical_um(),
          mechanics_.column.mechanical_um(),
          lamp_on_,
          condition_.lamp_share,
          mechanics_.vibration_mm_s(),
          mechanics_.column.position_um(),
          condition_.lamp_field,
          condition_.film,
          condition_.displacement};
}

CameraCondition Rig::camera_condition() const {
  const std::lock_guard lock(mutex_);
  return condition_.camera;
}

bool Rig::lines_silent() const {
  const std::lock_guard lock(mutex_);
  return condition_.lines_silent;
}

CameraCondition Rig::begin_capture() {
  const std::lock_guard lock(mutex_);
  schedule_.capture_begins();
  follow_schedule();
  return condition_.camera;
}

void Rig::end_capture() {
  const std::lock_guard lock(mutex_);
  schedule_.capture_ends();
  follow_schedule();
}

void Rig::note_camera_failure() {
  const std::lock_guard lock(mutex_);
  schedule_.camera_failed();
  follow_schedule();
}

double Rig::rig_seconds() const {
  const std::lock_guard lock(mutex_);
  return rig_s_;
}

}  // namespace biotomy::sim
