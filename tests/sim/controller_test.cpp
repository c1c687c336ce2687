#include "sim/control/controller.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "sim/control/controller_registers.hpp"

namespace biotomy::sim {
namespace {

using namespace std::chrono_literals;

/// A controller with its machine in a clock of its own.
struct Bench {
  ControllerSettings settings;
  Mechanics mechanics{MechanicsSettings{}, Block(1, 900, 0, DebrisSettings{})};
  std::vector<Fault> faults;
  std::vector<CommandResult> results;
  ControllerEvents events{
      .finished = [this](const Command&, CommandResult result) { results.push_back(result); },
      .faulted = [this](Fault fault) { faults.push_back(fault); }};
  Controller controller{settings, mechanics, events};
  Controller::RealTime now{};
  std::uint32_t sequence = 0;

  explicit Bench(const ControllerSettings& with = {}) : settings(with) { run(1s); }

  void run(std::chrono::milliseconds time) {
    for (std::chrono::milliseconds t{0}; t < time; t += 4ms) {
      now += 4ms;
      mechanics.advance(0.004);
      controller.advance(0.004, now);
    }
  }
  Acceptance give(Action action, double position_um = 0, double rpm = 3000, double ms = 500) {
    return controller.submit(
        {++sequence, static_cast<std::uint16_t>(action), position_um, ms, rpm});
  }
  CommandResult complete(Action action, double position_um = 0, double rpm = 3000) {
    EXPECT_EQ(give(action, position_um, rpm), Acceptance::taken);
    run(60s);
    EXPECT_EQ(controller.memory().sequence_finished, sequence);
    return controller.memory().result;
  }
  ControllerState state() const { return controller.status().state; }
  void beat() { controller.hear_master(++master); }
  std::uint16_t master = 0;
};

TEST(Controller, StartsACommandUnderANewNumberAndEchoesIt) {
  Bench bench;
  EXPECT_EQ(bench.give(Action::home), Acceptance::taken);
  EXPECT_EQ(bench.state(), ControllerState::busy);
  EXPECT_EQ(bench.controller.memory().sequence_started, 1U);
  EXPECT_EQ(bench.controller.memory().sequence_finished, 0U);
  bench.run(20s);
  EXPECT_EQ(bench.state(), ControllerState::idle);
  EXPECT_EQ(bench.controller.memory().sequence_finished, 1U);
  EXPECT_EQ(bench.controller.memory().result, CommandResult::done);
  EXPECT_TRUE(bench.controller.status().homed);
}

TEST(Controller, DoesNothingForANumberThatItKnows) {
  Bench bench;
  bench.complete(Action::home);
  bench.complete(Action::grind_pass, 1000);
  const Command same{bench.sequence, static_cast<std::uint16_t>(Action::grind_pass), 1050, 0, 3000};
  EXPECT_EQ(bench.controller.submit(same), Acceptance::repeated);
  bench.run(30s);
  EXPECT_EQ(bench.controller.memory().grind_count, 1U);
  EXPECT_EQ(bench.mechanics.block().deepest_um(), 1000);
}

TEST(Controller, DoesNothingForACommandThatComesLate) {
  Bench bench;
  bench.complete(Action::home);
  bench.complete(Action::grind_pass, 1000);
  const Command late{bench.sequence, static_cast<std::uint16_t>(Action::grind_pass), 1000, 0, 3000};
  bench.complete(Action::retract);
  EXPECT_EQ(bench.controller.submit(late), Acceptance::repeated);
  bench.run(30s);
  EXPECT_EQ(bench.controller.memory().grind_count, 1U);
  EXPECT_EQ(bench.controller.status().state, ControllerState::idle);
}

TEST(Controller, GrindsToTheTargetAndCountsIt) {
  Bench bench;
  bench.complete(Action::home);
  EXPECT_EQ(bench.complete(Action::grind_pass, 1000), CommandResult::done);
  EXPECT_EQ(bench.mechanics.feed.position_um(), 1000);
  EXPECT_EQ(bench.mechanics.block().shallowest_um(), 1000);
  EXPECT_EQ(bench.controller.memory().ground_position_um, 1000);
  EXPECT_EQ(bench.complete(Action::retract), CommandResult::done);
  EXPECT_EQ(bench.mechanics.traverse.position_um(), 0);
  EXPECT_EQ(bench.mechanics.spindle_rpm(), 0);
  EXPECT_LT(bench.mechanics.feed.position_um(), 1000);
  EXPECT_EQ(bench.complete(Action::grind_pass, 1010), CommandResult::done);
  EXPECT_EQ(bench.controller.memory().grind_count, 2U);
  EXPECT_EQ(bench.mechanics.block().mean_um(), 1010);
}

TEST(Controller, TakesNothingButStopWhileBusy) {
  Bench bench;
  bench.complete(Action::home);
  bench.give(Action::move_column, 40000);
  bench.run(1s);
  EXPECT_EQ(bench.give(Action::clear_face), Acceptance::busy);
  EXPECT_EQ(bench.controller.memory().sequence_started, bench.sequence - 1);
  EXPECT_EQ(bench.give(Action::stop), Acceptance::taken);
  EXPECT_EQ(bench.controller.memory().sequence_finished, bench.sequence);
  EXPECT_EQ(bench.controller.memory().result, CommandResult::done);
  EXPECT_EQ(bench.results,
            (std::vector{CommandResult::done, CommandResult::aborted, CommandResult::done}));
  const double halted_um = bench.mechanics.column.position_um();
  bench.run(5s);
  EXPECT_EQ(bench.mechanics.column.position_um(), halted_um);
}

TEST(Controller, RefusesWhatItCannotDo) {
  Bench bench;
  EXPECT_EQ(bench.complete(Action::grind_pass, 1000), CommandResult::refused);  // not homed
  EXPECT_EQ(bench.complete(Action::move_column, 1000), CommandResult::refused);
  bench.complete(Action::home);
  EXPECT_EQ(bench.complete(Action::grind_pass, 60001), CommandResult::refused);
  EXPECT_EQ(bench.complete(Action::grind_pass, -1), CommandResult::refused);
  EXPECT_EQ(bench.complete(Action::grind_pass, 1000, 0), CommandResult::refused);
  EXPECT_EQ(bench.complete(Action::grind_pass, 1000, 6001), CommandResult::refused);
  EXPECT_EQ(bench.complete(Action::move_column, 60001), CommandResult::refused);
  EXPECT_EQ(bench.complete(static_cast<Action>(8)), CommandResult::refused);
  EXPECT_EQ(bench.controller.memory().grind_count, 0U);
  EXPECT_EQ(bench.mechanics.block().deepest_um(), 900);
}

TEST(Controller, BlowsForAsLongAsItIsTold) {
  Bench bench;
  bench.give(Action::clear_face, 0, 0, 500);
  bench.run(400ms);
  EXPECT_TRUE(bench.mechanics.air_on());
  bench.run(200ms);
  EXPECT_FALSE(bench.mechanics.air_on());
  EXPECT_NEAR(bench.mechanics.block().state().blown_ms, 500, 20);
}

TEST(Controller, StopsTheWheelAtOnceForTheEstopAndTheDoor) {
  for (const auto& [inputs, fault] : {std::pair(SafetyInputs{true, false}, Fault::estop),
                                      std::pair(SafetyInputs{false, true}, Fault::door)}) {
    Bench bench;
    bench.complete(Action::home);
    bench.give(Action::grind_pass, 1000);
    while (!bench.mechanics.cutting()) bench.run(4ms);
    bench.run(500ms);
    bench.controller.set_inputs(inputs);
    EXPECT_EQ(bench.state(), ControllerState::faulted);
    EXPECT_EQ(bench.controller.memory().result, CommandResult::aborted);
    EXPECT_EQ(bench.controller.memory().sequence_finished, bench.sequence);
    bench.run(3s);
    EXPECT_EQ(bench.mechanics.spindle_rpm(), 0);
    EXPECT_LT(bench.mechanics.feed.position_um(), 900);
    EXPECT_EQ(bench.controller.memory().grind_count, 0U);
    EXPECT_LT(bench.mechanics.block().shallowest_um(), bench.mechanics.block().deepest_um());
    EXPECT_EQ(bench.faults, std::vector{fault});
  }
}

TEST(Controller, StaysFaultedUntilItIsResetWithTheCauseGone) {
  Bench bench;
  bench.complete(Action::home);
  bench.controller.set_inputs({true, false});
  EXPECT_EQ(bench.complete(Action::reset_fault), CommandResult::refused);
  bench.controller.set_inputs({false, false});
  bench.run(1s);
  EXPECT_EQ(bench.state(), ControllerState::faulted);
  EXPECT_EQ(bench.complete(Action::retract), CommandResult::refused);
  EXPECT_EQ(bench.state(), ControllerState::faulted);
  EXPECT_EQ(bench.complete(Action::reset_fault), CommandResult::done);
  EXPECT_EQ(bench.state(), ControllerState::idle);
  EXPECT_EQ(bench.controller.status().fault, Fault::none);
  EXPECT_EQ(bench.complete(Action::retract), CommandResult::done);
}

TEST(Controller, TellsTheFirstCauseWhenSeveralCome) {
  Bench bench;
  bench.controller.set_inputs({false, true});
  bench.controller.set_inputs({true, true});
  EXPECT_EQ(bench.controller.status().fault, Fault::door);
  EXPECT_TRUE(bench.controller.status().estop_pressed);
}

TEST(Controller, ComesUpFaultedIfTheEstopIsPressedMeanwhile) {
  ControllerSettings settings;
  settings.boot_seconds = 2;
  Bench bench(settings);
  EXPECT_EQ(bench.state(), ControllerState::booting);
  EXPECT_EQ(bench.give(Action::home), Acceptance::busy);
  bench.controller.set_inputs({true, false});
  EXPECT_EQ(bench.state(), ControllerState::booting);
  bench.run(2s);
  EXPECT_EQ(bench.state(), ControllerState::faulted);
}

TEST(Controller, WatchesItsMasterFromTheFirstHeartbeatOn) {
  Bench bench;
  bench.run(10s);
  EXPECT_EQ(bench.state(), ControllerState::idle);
  for (int i = 0; i < 10; ++i) {
    bench.beat();
    bench.run(1s);
  }
  EXPECT_EQ(bench.state(), ControllerState::idle);
  for (int i = 0; i < 11; ++i) {
    bench.controller.hear_master(bench.master);  // written, but not changed
    bench.run(100ms);
  }
  EXPECT_EQ(bench.state(), ControllerState::faulted);
  EXPECT_EQ(bench.controller.status().fault, Fault::watchdog);
  EXPECT_TRUE(bench.controller.status().watchdog_tripped);
  EXPECT_EQ(bench.complete(Action::reset_fault), CommandResult::refused);
  bench.beat();
  bench.run(8ms);
  EXPECT_EQ(bench.give(Action::reset_fault), Acceptance::taken);
  EXPECT_EQ(bench.controller.memory().result, CommandResult::done);
  EXPECT_FALSE(bench.controller.status().watchdog_tripped);
}

TEST(Controller, ReportsADriveThatDoesNotMoveAndKeepsItWhileItIsStalled) {
  for (const auto stalled : {&MachineDefects::feed, &MachineDefects::traverse}) {
    Bench bench;
    bench.complete(Action::home);
    bench.give(Action::grind_pass, 10000);
    bench.run(1500ms);
    MachineDefects defects;
    (defects.*stalled).stalled = true;
    bench.mechanics.set_defects(defects);
    bench.run(400ms);
    EXPECT_EQ(bench.state(), ControllerState::busy);
    bench.run(10s);
    EXPECT_EQ(bench.state(), ControllerState::faulted);
    EXPECT_EQ(bench.controller.status().fault, Fault::drive);
    EXPECT_EQ(bench.controller.memory().result, CommandResult::aborted);
    EXPECT_EQ(bench.controller.memory().grind_count, 0U);
  }
}

TEST(Controller, DoesNotResetADriveThatCannotLiftTheWheel) {
  Bench bench;
  bench.complete(Action::home);
  bench.complete(Action::grind_pass, 1000);
  bench.mechanics.set_defects({.feed = {.stalled = true}});
  bench.complete(Action::retract);
  EXPECT_EQ(bench.controller.status().fault, Fault::drive);
  EXPECT_EQ(bench.complete(Action::reset_fault), CommandResult::refused);
  bench.mechanics.set_defects({});
  bench.run(2s);
  EXPECT_EQ(bench.mechanics.feed.position_um(), 0);  // lifted at last
  EXPECT_EQ(bench.complete(Action::reset_fault), CommandResult::done);
}

TEST(Controller, ReportsADriveThatDoesNotStandWhereItShould) {
  Bench bench;
  bench.complete(Action::home);
  bench.complete(Action::move_column, 5000);
  bench.mechanics.set_defects({.column = {.creep_um_s = 10}});
  bench.run(1900ms);
  EXPECT_EQ(bench.state(), ControllerState::idle);
  bench.run(1s);
  EXPECT_EQ(bench.controller.status().fault, Fault::drive);
  bench.run(10s);
  bench.mechanics.set_defects({});
  EXPECT_EQ(bench.complete(Action::reset_fault), CommandResult::done);  // from where it is now
}

TEST(Controller, ReportsASpindleThatDoesNotStart) {
  Bench bench;
  bench.complete(Action::home);
  bench.mechanics.set_defects({.spindle_blocked = true});
  EXPECT_EQ(bench.complete(Action::grind_pass, 1000), CommandResult::aborted);
  EXPECT_EQ(bench.controller.status().fault, Fault::drive);
  EXPECT_EQ(bench.mechanics.block().deepest_um(), 900);
}

TEST(Controller, ReportsASpindleThatDoesNotStop) {
  Bench bench;
  bench.complete(Action::home);
  EXPECT_EQ(bench.complete(Action::grind_pass, 1000), CommandResult::done);
  bench.mechanics.set_defects({.spindle_runs_on = true});
  EXPECT_EQ(bench.complete(Action::retract), CommandResult::aborted);
  EXPECT_EQ(bench.controller.status().fault, Fault::drive);
  bench.run(10s);
  EXPECT_GT(bench.mechanics.spindle_rpm(), 0);
  bench.mechanics.set_defects({});
  bench.run(10s);
  EXPECT_EQ(bench.mechanics.spindle_rpm(), 0);
}

TEST(Controller, ReportsAnAxisBeyondItsLimitAndBringsItBack) {
  Bench bench;
  bench.complete(Action::home);
  bench.complete(Action::move_column, 60000);
  bench.mechanics.set_defects({.column = {.creep_um_s = 1000}});
  bench.run(100ms);
  EXPECT_EQ(bench.controller.status().fault, Fault::limit);
  bench.complete(Action::reset_fault);
  EXPECT_EQ(bench.controller.status().fault, Fault::limit);  // still, or again
  bench.mechanics.set_defects({});
  bench.run(1s);
  EXPECT_EQ(bench.mechanics.column.position_um(), 60000);
  EXPECT_EQ(bench.complete(Action::reset_fault), CommandResult::done);
}

TEST(Controller, StopsAnOverloadedSpindleOnceItLasts) {
  Bench bench;
  bench.complete(Action::home);
  bench.give(Action::grind_pass, 1000);
  while (!bench.mechanics.cutting()) bench.run(4ms);
  bench.mechanics.set_defects({.extra_load_percent = 100});
  bench.run(200ms);
  EXPECT_EQ(bench.state(), ControllerState::busy);
  bench.run(200ms);
  EXPECT_EQ(bench.controller.status().fault, Fault::spindle_overload);
  bench.run(2s);
  EXPECT_EQ(bench.mechanics.spindle_rpm(), 0);
  EXPECT_EQ(bench.complete(Action::reset_fault), CommandResult::done);
}

TEST(Controller, KeepsTheFirstCauseWhenAnotherComes) {
  Bench bench;
  bench.complete(Action::home);
  bench.controller.set_inputs({false, true});
  bench.mechanics.set_defects({.column = {.creep_um_s = 1000}});
  bench.run(2s);
  EXPECT_EQ(bench.controller.status().fault, Fault::door);
  EXPECT_GT(bench.mechanics.column.position_um(), 1900);  // not a step while the door is open
}

TEST(Controller, ForgetsAllButItsPermanentMemoryWithoutPower) {
  Bench bench;
  bench.complete(Action::home);
  bench.complete(Action::grind_pass, 1000);
  bench.beat();
  bench.give(Action::move_column, 50000);
  bench.run(1s);
  bench.controller.set_power(false);
  EXPECT_EQ(bench.give(Action::stop), Acceptance::busy);
  bench.run(5s);
  EXPECT_EQ(bench.mechanics.spindle_rpm(), 0);
  const double column_um = bench.mechanics.column.position_um();
  EXPECT_LT(column_um, 50000);
  bench.controller.set_power(true);
  EXPECT_EQ(bench.state(), ControllerState::booting);
  bench.run(5s);
  EXPECT_EQ(bench.state(), ControllerState::idle);  // and its master is watched anew
  EXPECT_FALSE(bench.controller.status().homed);
  EXPECT_EQ(bench.controller.memory().result, CommandResult::aborted);
  EXPECT_EQ(bench.controller.memory().grind_count, 1U);
  EXPECT_EQ(bench.mechanics.column.position_um(), column_um);
}

TEST(Controller, GoesOnWhileItsHeartbeatStands) {
  Bench bench;
  bench.controller.stop_heartbeat(true);
  const auto before = bench.controller.status().heartbeat;
  EXPECT_EQ(bench.complete(Action::home), CommandResult::done);
  EXPECT_EQ(bench.controller.status().heartbeat, before);
}

TEST(Controller, HasAHeartbeatOfItsOwn) {
  Bench bench;
  const auto before = bench.controller.status().heartbeat;
  bench.run(100ms);
  EXPECT_NE(bench.controller.status().heartbeat, before);
}

TEST(Controller, CallsACommandAbortedThatARestartBrokeOff) {
  Bench bench;
  bench.controller.restore({.sequence_started = 7,
                            .sequence_finished = 6,
                            .result = CommandResult::done,
                            .grind_count = 3,
                            .ground_position_um = 1020});
  EXPECT_EQ(bench.controller.memory().sequence_finished, 7U);
  EXPECT_EQ(bench.controller.memory().result, CommandResult::aborted);
  EXPECT_EQ(bench.controller.memory().grind_count, 3U);
}

struct Registers {
  ControllerRegisters registers{
      bridge::RegisterMap::read_file(BIOTOMY_ROOT "/firmware_bridge/register_map.toml")};
};

TEST(ControllerRegisters, ShowTheReadingAsTheMapHasIt) {
  Registers r;
  ControllerReading reading;
  reading.status.state = ControllerState::faulted;
  reading.status.estop_pressed = true;
  reading.status.homed = true;
  reading.memory.sequence_started = 0x10002;
  reading.feed_um = -12.3;
  reading.feed_target_um = -20;
  reading.traverse_maximum_um = 160000;
  reading.spindle_load_percent = 1e9;  // more than the register holds
  r.registers.show(reading);
  const auto input = r.registers.input();
  EXPECT_EQ(input[0], 0xB107);
  EXPECT_EQ(input[2], 3);
  EXPECT_EQ(input[4], 0b1001);
  EXPECT_EQ(input[8], 1);
  EXPECT_EQ(input[9], 2);
  EXPECT_EQ(static_cast<std::int32_t>((input[14] << 16) | input[15]), -123);
  EXPECT_EQ(input[23], 65535);
  EXPECT_EQ(static_cast<std::int32_t>((input[28] << 16) | input[29]), -200);
  EXPECT_EQ((input[40] << 16) | input[41], 1600000);
}

TEST(ControllerRegisters, TakeTheCommandWithItsSequenceNumber) {
  Registers r;
  const std::vector<std::uint16_t> block{2, 0, 10000, 250, 3000, 0, 9};
  EXPECT_TRUE(r.registers.judge(1, 7).command);
  EXPECT_FALSE(r.registers.judge(1, 7).heartbeat);
  EXPECT_FALSE(r.registers.judge(0, 6).command);
  EXPECT_TRUE(r.registers.judge(0, 1).heartbeat);
  const Command command = r.registers.command_after(1, block);
  EXPECT_EQ(command.sequence, 9U);
  EXPECT_EQ(command.action, 2);
  EXPECT_DOUBLE_EQ(command.position_um, 1000);
  EXPECT_DOUBLE_EQ(command.duration_ms, 250);
  EXPECT_DOUBLE_EQ(command.spindle_rpm, 3000);
}

TEST(ControllerRegisters, GiveTheEchoBackAndTakeItForNothingElse) {
  Registers r;
  const RegisterWrite write = r.registers.judge(8, 1);
  EXPECT_TRUE(write.allowed);
  EXPECT_FALSE(write.command);
  EXPECT_FALSE(write.heartbeat);
  r.registers.write(8, std::vector<std::uint16_t>{0xBEEF});
  EXPECT_EQ(r.registers.holding()[8], 0xBEEF);
}

TEST(ControllerRegisters, LetNobodyWriteWhatIsNotThereOrHalfANumber) {
  Registers r;
  EXPECT_FALSE(r.registers.judge(9, 1).allowed);
  EXPECT_FALSE(r.registers.judge(0, 10).allowed);
  EXPECT_FALSE(r.registers.judge(6, 1).allowed);
  EXPECT_TRUE(r.registers.judge(6, 2).allowed);
}

}  // namespace
}  // namespace biotomy::sim
