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
      block_before_(mechanics_.block()),
      now_(now),
      state_written_at_(now) {
  if (const std::optional<RigState> state = state_file_.read()) {
    mechanics_.restore(state->block, state->feed_um, state->traverse_um, state->column_um);
    controller_.restore(state->memory);
  }
  write_state();
  witness_.twin_started(rig_s_, settings_.seed, controller_.memory(), mechanics_.block());
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
          .memory_changed = [this] { write_state(); }};
}

void Rig::finish_command(const Command& command, CommandResult result) {
  const Block& block = mechanics_.block();
  if (static_cast<Action>(command.action) == Action::grind_pass &&
      block.state().passes != block_before_.state().passes) {
    witness_.grind_pass(rig_s_, command, result, block_before_, block);
  }
  witness_.command_finished(rig_s_, command, result);
}

void Rig::advance(RealTime now) {
  const std::lock_guard lock(mutex_);
  double left_s = settings_.time_scale * std::chrono::duration<double>(now - now_).count();
  now_ = now;
  while (left_s > 0.0) {
    const double step_s = std::min(left_s, kStepSeconds);
    left_s -= step_s;
    rig_s_ += step_s;
    mechanics_.advance(step_s);
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
  state_file_.write({controller_.memory(), mechanics_.block().state(),
                     mechanics_.feed.position_um(), mechanics_.traverse.position_um(),
                     mechanics_.column.position_um()});
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
  return controller_.submit(command);
}

SafetyInputs Rig::inputs() const {
  const std::lock_guard lock(mutex_);
  return inputs_;
}

void Rig::set_input(bridge::RigInput input, bool on) {
  const std::lock_guard lock(mutex_);
  bool& state = input == bridge::RigInput::estop ? inputs_.estop_pressed : inputs_.door_open;
  if (std::exchange(state, on) != on) {
    witness_.input_changed(rig_s_, name_of(input), on);
    controller_.set_inputs(inputs_);
  }
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
  return {mechanics_.block(), mechanics_.traverse.position_um(), mechanics_.column.position_um(),
          lamp_on_};
}

double Rig::rig_seconds() const {
  const std::lock_guard lock(mutex_);
  return rig_s_;
}

}  // namespace biotomy::sim
