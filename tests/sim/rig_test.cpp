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
