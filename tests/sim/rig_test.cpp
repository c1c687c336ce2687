#include "sim/service/rig.hpp"

#include <fstream>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/temporary_folder.hpp"

namespace biotomy::sim {
namespace {

using namespace std::chrono_literals;

/// A rig in a clock of its own, with files.
struct Workshop {
  tests::TemporaryFolder folder;
  RigSettings settings{.time_scale = 10, .initial_face_um = 900, .roughness_um = 0};
  Rig::RealTime now{};

  std::vector<nlohmann::json> witness(const std::string& event) const {
    std::ifstream file(folder / "witness.jsonl");
    std::vector<nlohmann::json> lines;
    for (std::string line; std::getline(file, line);) {
      nlohmann::json json = nlohmann::json::parse(line);
      if (json.at("event") == event) lines.push_back(json);
    }
    return lines;
  }
};

struct RunningRig {
  explicit RunningRig(Workshop& workshop)
      : shop(workshop),
        log(workshop.folder / "witness.jsonl",
            [] { return std::chrono::system_clock::time_point(); }),
        rig(workshop.settings, StateFile(workshop.folder / "state.json"), log, workshop.now) {
    run(100ms);
  }
  void run(std::chrono::milliseconds time) {
    for (std::chrono::milliseconds t{0}; t < time; t += 10ms) rig.advance(shop.now += 10ms);
  }
  CommandResult complete(std::uint32_t sequence, Action action, double position_um = 0) {
    rig.submit({sequence, static_cast<std::uint16_t>(action), position_um, 600, 3000});
    run(6s);
    return rig.read().memory.result;
  }
  Workshop& shop;
  WitnessLog log;
  Rig rig;
};

TEST(Rig, RemembersAcrossARestartWhatItGround) {
  Workshop shop;
  {
    RunningRig first(shop);
    EXPECT_EQ(first.complete(1, Action::home), CommandResult::done);
    EXPECT_EQ(first.complete(2, Action::grind_pass, 1000), CommandResult::done);
  }  // killed: nothing is written at the end
  RunningRig second(shop);
  const ControllerReading reading = second.rig.read();
  EXPECT_EQ(reading.memory.sequence_started, 2U);
  EXPECT_EQ(reading.memory.sequence_finished, 2U);
  EXPECT_EQ(reading.memory.grind_count, 1U);
  EXPECT_EQ(reading.memory.ground_position_um, 1000);
  EXPECT_EQ(second.rig.scene().block.mean_um(), 1000);
  EXPECT_FALSE(reading.status.homed);
  EXPECT_EQ(second.rig.submit({2, 2, 1100, 0, 3000}), Acceptance::repeated);
}

TEST(Rig, FindsACommandAbortedThatAKillBrokeOff) {
  Workshop shop;
  {
    RunningRig first(shop);
    first.complete(1, Action::home);
    first.rig.submit({2, static_cast<std::uint16_t>(Action::grind_pass), 1000, 0, 3000});
    first.run(200ms);
  }
  RunningRig second(shop);
  EXPECT_EQ(second.rig.read().memory.sequence_finished, 2U);
  EXPECT_EQ(second.rig.read().memory.result, CommandResult::aborted);
  EXPECT_EQ(second.rig.read().memory.grind_count, 0U);
}

TEST(Rig, DoesNotHealTheBlockWhenItIsKilledDuringAPass) {
  Workshop shop;
  const auto pass = static_cast<std::uint16_t>(Action::grind_pass);
  double mean_um = 0;
  {
    RunningRig first(shop);
    first.complete(1, Action::home);
    first.rig.submit({2, pass, 1000, 0, 3000});
    while (first.rig.scene().block.deepest_um() < 1000) first.run(10ms);
    first.run(20ms);
    const Block block = first.rig.scene().block;
    ASSERT_EQ(block.shallowest_um(), 900) << "the pass is over already";
    mean_um = block.mean_um();
  }
  RunningRig second(shop);
  EXPECT_EQ(second.rig.scene().block.mean_um(), mean_um);
  const auto started = shop.witness("twin_started");
  ASSERT_EQ(started.size(), 2U);
  EXPECT_EQ(started[1].at("sequence"), 2);
  EXPECT_EQ(started[1].at("result"), "aborted");
  EXPECT_EQ(started[1].at("grind_count"), 0);
  EXPECT_EQ(started[1].at("passes"), 1);
  EXPECT_EQ(started[1].at("face").at("mean_um"), mean_um);
}

TEST(Rig, RefusesADamagedStateFile) {
  Workshop shop;
  std::ofstream(shop.folder / "state.json") << "{\"version\": 1, \"sequence";
  EXPECT_THROW(RunningRig{shop}, std::runtime_error);
}

TEST(Rig, TellsTheWitnessWhatWasTrulyDone) {
  Workshop shop;
  RunningRig rig(shop);
  rig.complete(1, Action::home);
  rig.complete(2, Action::grind_pass, 1000);
  rig.rig.set_input(bridge::RigInput::door, true);
  rig.rig.set_input(bridge::RigInput::door, true);
  const auto passes = shop.witness("grind_pass");
  ASSERT_EQ(passes.size(), 1U);
  EXPECT_EQ(passes[0].at("sequence"), 2);
  EXPECT_EQ(passes[0].at("before").at("mean_um"), 900);
  EXPECT_EQ(passes[0].at("after").at("mean_um"), 1000);
  EXPECT_EQ(passes[0].at("result"), "done");
  EXPECT_EQ(passes[0].at("time"), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(shop.witness("command_started").size(), 2U);
  EXPECT_EQ(shop.witness("command_finished").size(), 2U);
  ASSERT_EQ(shop.witness("faulted").size(), 1U);
  EXPECT_EQ(shop.witness("faulted")[0].at("fault"), "door");
  EXPECT_EQ(shop.witness("input_changed").size(), 1U);
}

TEST(Rig, HasOneTruthForLinesAndController) {
  Workshop shop;
  RunningRig rig(shop);
  rig.rig.set_input(bridge::RigInput::estop, true);
  EXPECT_TRUE(rig.rig.inputs().estop_pressed);
  EXPECT_TRUE(rig.rig.read().status.estop_pressed);
  EXPECT_EQ(rig.rig.read().status.fault, Fault::estop);
  rig.rig.set_output(bridge::RigOutput::lamp, true);
  EXPECT_TRUE(rig.rig.scene().lamp_on);
}

ScenarioEvent lasting(const char* name, const RigFault& fault) {
  return {.name = name, .fault = fault, .when = {}, .lasts = {}};
}

TEST(Rig, FollowsItsScenarioAndTellsTheWitness) {
  Workshop shop;
  shop.settings.scenario.events = {
      {.name = "press",
       .fault = EstopPressed{},
       .when = {.moment = Occasion::Moment::grind_started, .at = 1, .delay_s = 1},
       .lasts = {.until_reset = true}}};
  RunningRig rig(shop);
  EXPECT_EQ(rig.complete(1, Action::home), CommandResult::done);
  EXPECT_EQ(rig.complete(2, Action::grind_pass, 1000), CommandResult::aborted);
  EXPECT_TRUE(rig.rig.inputs().estop_pressed);
  EXPECT_EQ(rig.rig.read().status.fault, Fault::estop);
  EXPECT_EQ(rig.complete(3, Action::reset_fault), CommandResult::done);
  EXPECT_FALSE(rig.rig.inputs().estop_pressed);
  EXPECT_EQ(rig.complete(4, Action::grind_pass, 1000), CommandResult::done);
  ASSERT_EQ(shop.witness("fault_began").size(), 1U);
  EXPECT_EQ(shop.witness("fault_began")[0].at("name"), "press");
  EXPECT_EQ(shop.witness("fault_began")[0].at("fault"), "estop_pressed");
  EXPECT_EQ(shop.witness("fault_ended").size(), 1U);
  EXPECT_EQ(shop.witness("input_changed").size(), 2U);
}

TEST(Rig, LosesTheControllersPowerAndFindsItsMemoryAgain) {
  Workshop shop;
  RunningRig rig(shop);
  rig.complete(1, Action::home);
  rig.complete(2, Action::grind_pass, 1000);
  rig.rig.submit({3, static_cast<std::uint16_t>(Action::grind_pass), 1020, 0, 3000});
  while (rig.rig.read().spindle_load_percent < 8) rig.run(10ms);  // it cuts
  rig.run(50ms);
  rig.rig.add_event(lasting("cut", ControllerPowerCut{}));
  EXPECT_FALSE(rig.rig.answers());
  EXPECT_EQ(rig.rig.submit({4, 3, 0, 0, 0}), Acceptance::busy);
  rig.run(1s);
  EXPECT_EQ(rig.rig.read().spindle_rpm, 0);
  EXPECT_TRUE(rig.rig.end_event("cut"));
  EXPECT_TRUE(rig.rig.answers());
  EXPECT_EQ(rig.rig.read().status.state, ControllerState::booting);
  rig.run(1s);
  const ControllerReading reading = rig.rig.read();
  EXPECT_EQ(reading.status.state, ControllerState::idle);
  EXPECT_FALSE(reading.status.homed);
  EXPECT_EQ(reading.memory.sequence_started, 3U);
  EXPECT_EQ(reading.memory.sequence_finished, 3U);
  EXPECT_EQ(reading.memory.result, CommandResult::aborted);
  EXPECT_EQ(reading.memory.grind_count, 1U);
  EXPECT_EQ(shop.witness("controller_power_lost").size(), 1U);
  EXPECT_EQ(shop.witness("controller_restarted").size(), 1U);
  EXPECT_EQ(shop.witness("homed").size(), 1U);
  EXPECT_EQ(shop.witness("homing_lost").size(), 1U);
  const auto passes = shop.witness("grind_pass");
  ASSERT_EQ(passes.size(), 2U);
  EXPECT_EQ(passes[1].at("result"), "aborted");
  EXPECT_GT(passes[1].at("removed_um"), 0);
}

TEST(Rig, TellsTheWitnessHowLongTheSpindleRan) {
  Workshop shop;
  RunningRig rig(shop);
  rig.complete(1, Action::home);
  rig.complete(2, Action::grind_pass, 1000);
  rig.rig.set_input(bridge::RigInput::estop, true);
  rig.run(1s);
  ASSERT_EQ(shop.witness("spindle_started").size(), 1U);
  EXPECT_EQ(shop.witness("spindle_started")[0].at("target_rpm"), 3000);
  ASSERT_EQ(shop.witness("spindle_stopped").size(), 1U);
  const nlohmann::json stopped = shop.witness("spindle_stopped")[0];
  EXPECT_NEAR(stopped.at("run_down_s"), 1.0, 0.05);  // 3000 rpm at 3000 rpm/s
  EXPECT_NEAR(
      stopped.at("rig_s").get<double>() - shop.witness("faulted")[0].at("rig_s").get<double>(), 1.0,
      0.05);
}

TEST(Rig, GrindsNothingWithAWheelThatDoesNotTouch) {
  Workshop shop;
  RunningRig rig(shop);
  rig.complete(1, Action::home);
  rig.rig.add_event(lasting("high", GrindRemovesNothing{}));
  EXPECT_EQ(rig.complete(2, Action::grind_pass, 1000), CommandResult::done);
  EXPECT_EQ(rig.rig.read().memory.grind_count, 1U);
  EXPECT_EQ(rig.rig.scene().block.mean_um(), 900);
  ASSERT_EQ(shop.witness("grind_pass").size(), 1U);
  EXPECT_EQ(shop.witness("grind_pass")[0].at("removed_um"), 0);
  rig.rig.end_event("high");
  rig.rig.add_event(lasting("short", GrindRemovesTooLittle{15}));
  rig.complete(3, Action::grind_pass, 1020);
  EXPECT_EQ(rig.rig.scene().block.mean_um(), 1005);
}

TEST(Rig, KeepsItsDebrisWhileTheAirDoesNotReachIt) {
  Workshop shop;
  RunningRig rig(shop);
  rig.complete(1, Action::home);
  rig.complete(2, Action::grind_pass, 1000);
  rig.rig.add_event(lasting("clogged", DebrisSticks{}));
  rig.complete(3, Action::clear_face);
  EXPECT_EQ(rig.rig.scene().block.debris().size(), 40U);
  rig.rig.end_event("clogged");
  rig.complete(4, Action::clear_face);
  EXPECT_EQ(rig.rig.scene().block.debris().size(), 0U);
}

TEST(Rig, ShowsAScaleThatIsWrongAndTheTruthToTheCamera) {
  Workshop shop;
  RunningRig rig(shop);
  rig.complete(1, Action::home);
  rig.complete(2, Action::move_column, 5000);
  rig.rig.add_event(lasting("scale", AxisReadsWrong{MachineAxis::column, 15}));
  rig.run(100ms);
  EXPECT_EQ(rig.rig.read().column_um, 5015);
  EXPECT_EQ(rig.rig.scene().column_scale_um, 5015);
  EXPECT_EQ(rig.rig.scene().column_um, 5000);
}

TEST(Rig, ShowsTheCameraWhatIsWrongWithLightAndFace) {
  Workshop shop;
  RunningRig rig(shop);
  rig.rig.add_event(lasting("reflector", LampLightsUnevenly{0.2, 0.1}));
  rig.rig.add_event(lasting("rime", FaceFrosts{0.3, 0.4}));
  rig.rig.add_event(lasting("slip", BlockShifts{50, -20}));
  EXPECT_EQ(rig.rig.scene().lamp_field.slope_y, 0.1);
  EXPECT_EQ(rig.rig.scene().film.frost.share, 0.3);
  EXPECT_EQ(rig.rig.scene().displacement, (Displacement{50, -20}));
  rig.rig.end_event("rime");
  EXPECT_EQ(rig.rig.scene().film.frost.share, 0);
}

TEST(Rig, BeginsWithinItsLimits) {
  Workshop shop;
  shop.settings.controller.feed_minimum_um = 500;
  shop.settings.controller.column_minimum_um = -300;
  RunningRig rig(shop);
  rig.run(1s);
  EXPECT_EQ(rig.rig.read().status.state, ControllerState::idle);
  EXPECT_EQ(rig.rig.read().feed_um, 500);
  EXPECT_EQ(rig.rig.read().column_um, -300);
}

TEST(Rig, ScalesItsTimeButNotTheWatchdog) {
  Workshop shop;
  RunningRig rig(shop);
  const double before = rig.rig.rig_seconds();
  rig.rig.hear_master(1);
  rig.run(1s);
  EXPECT_NEAR(rig.rig.rig_seconds() - before, 10, 1e-6);
  EXPECT_EQ(rig.rig.read().status.state, ControllerState::idle);
  rig.run(1100ms);
  EXPECT_EQ(rig.rig.read().status.fault, Fault::watchdog);
}

}  // namespace
}  // namespace biotomy::sim
