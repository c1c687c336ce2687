#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "acquisition/rig/lens_actuator.hpp"
#include "acquisition/service/status_json.hpp"
#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using bridge::StageAction;
using testing::Each;
using testing::ElementsAre;
using testing::Ge;
using testing::HasSubstr;
using Progress = CalibrationStatus::Progress;

/// The face is sharp with the column at 600 µm.
struct FocusCalibrationTest : testing::Test {
  FocusCalibrationTest() {
    bench.settings.calibration.folder = bench.folder / "calibration";
    bench.settings.camera.settings.exposure = std::chrono::microseconds(10000);
    bench.settings.focus.start = {300.0};
    bench.stage.status.ground_to = {1000.0};
    start_daemon();
  }

  void start_daemon() {
    bench.start_daemon();
    bench.say(OperatorCommand::acknowledge);
    bench.stage.executed.clear();
  }

  OperatorReply calibrate() {
    OperatorReply reply = bench.say(OperatorCommand::calibrate_focus);
    for (int i = 0; i < 5000 && calibration().progress == Progress::running; ++i) bench.tick();
    return reply;
  }

  /// Begins to, and ticks until the stage is at this action; it does not end it any more.
  void calibrate_until(StageAction action) {
    bench.stage.on_command = [this, action](const bridge::StageCommand& command) {
      if (command.action == action) bench.stage.exchanges_per_command = 1000000;
    };
    bench.say(OperatorCommand::calibrate_focus);
    for (int i = 0; i < 1000 && bench.stage.count(action) == 0; ++i) bench.tick();
    bench.stage.on_command = [](const auto&) {};
    bench.stage.exchanges_per_command = 2;
    ASSERT_EQ(bench.stage.executed.back().command.action, action);
    ASSERT_EQ(calibration().progress, Progress::running);
  }

  /// What it failed for; the rig is stopped and latched, by a stop that was the next command.
  void expect_stopped(std::size_t executed_before, const std::string& cause) {
    ASSERT_GT(bench.stage.executed.size(), executed_before);
    EXPECT_EQ(bench.stage.executed[executed_before].command.action, StageAction::stop);
    EXPECT_EQ(calibration().progress, Progress::failed);
    EXPECT_THAT(calibration().sentence, HasSubstr(cause));
    EXPECT_EQ(bench.state(), JobState::faulted);
    EXPECT_THAT(bench.alarm(), HasSubstr(cause));
    EXPECT_FALSE(lit());
    EXPECT_FALSE(std::filesystem::exists(record_path()));
  }

  std::vector<double> column_targets() const {
    std::vector<double> targets;
    for (const FakeStage::Executed& entry : bench.stage.executed) {
      if (entry.command.action == StageAction::move_column) {
        targets.push_back(entry.command.position.value);
      }
    }
    return targets;
  }

  std::vector<StageAction> actions() const {
    std::vector<StageAction> done;
    for (const FakeStage::Executed& entry : bench.stage.executed) {
      if (done.empty() || done.back() != entry.command.action) done.push_back(entry.command.action);
    }
    return done;
  }

  CalibrationStatus calibration() const { return bench.board.look()->calibration; }
  std::filesystem::path record_path() const {
    return bench.settings.calibration.folder / "focus.json";
  }
  nlohmann::json record() const {
    std::ifstream file(record_path());
    return nlohmann::json::parse(file);
  }
  bool lit() const { return bench.lines.on.contains(bridge::OutputRole::lamp); }

  JobBench bench;
};

TEST_F(FocusCalibrationTest, FindsTheFocusFromAfarAndStaysThere) {
  EXPECT_TRUE(calibrate().accepted);
  ASSERT_EQ(calibration().progress, Progress::done) << calibration().sentence;
  EXPECT_THAT(calibration().sentence, HasSubstr("of the column: set focus.start_um = "));
  EXPECT_NEAR(bench.stage.status.column.value, 600.0, 4.0);
  EXPECT_EQ(record().at("plane_um"), bench.stage.status.column.value);
  EXPECT_FALSE(lit());
  EXPECT_EQ(bench.state(), JobState::idle);
  EXPECT_TRUE(bench.job->at_rest());
}

TEST_F(FocusCalibrationTest, HomesTheAxesAndParksTheBlockFirst) {
  calibrate();
  EXPECT_THAT(actions(),
              ElementsAre(StageAction::home, StageAction::retract, StageAction::move_column));
}

TEST_F(FocusCalibrationTest, LeavesAxesAloneThatAreHomed) {
  bench.stage.status.interlocks.homed = true;
  calibrate();
  EXPECT_THAT(actions(), ElementsAre(StageAction::retract, StageAction::move_column));
}

TEST_F(FocusCalibrationTest, BeginsWhereTheColumnWasBroughtTo) {
  bench.stage.status.interlocks.homed = true;
  bench.stage.status.column = {700.0};
  calibrate();
  EXPECT_EQ(calibration().progress, Progress::done) << calibration().sentence;
  EXPECT_THAT(column_targets(), Each(Ge(400.0))) << "it was sent to focus.start_um";
}

TEST_F(FocusCalibrationTest, BeginsAtTheConfiguredStartWhenTheColumnIsAtHome) {
  bench.stage.status.interlocks.homed = true;
  calibrate();
  EXPECT_NEAR(column_targets().at(1), 300.0, 50.0);
}

TEST_F(FocusCalibrationTest, BeginsAtTheConfiguredStartWhereverTheColumnStoodUnhomed) {
  bench.stage.status.column = {700.0};
  calibrate();
  EXPECT_NEAR(column_targets().at(1), 300.0, 50.0);
}

TEST_F(FocusCalibrationTest, FocusesWithALensAndLeavesTheColumnAlone) {
  bench.settings.focus.actuator = FocusSettings::Actuator::lens;
  bench.camera.lens = bridge::LensRange{.farthest = 1.0, .nearest = 10000.0};
  start_daemon();
  calibrate();
  ASSERT_EQ(calibration().progress, Progress::done) << calibration().sentence;
  EXPECT_THAT(calibration().sentence, HasSubstr("dioptres of the lens: set focus.start_um = "));
  EXPECT_THAT(column_targets(), ElementsAre());
  EXPECT_NEAR(distance_of(bench.camera.lens_positions.back()).value, 600.0, 4.0);
  EXPECT_EQ(record().at("actuator"), "lens");
}

TEST_F(FocusCalibrationTest, ALensThatIsNotThereIsToldBeforeAnythingMoves) {
  bench.settings.focus.actuator = FocusSettings::Actuator::lens;
  start_daemon();
  calibrate();
  EXPECT_THAT(calibration().sentence, HasSubstr("has none that can be driven"));
  EXPECT_TRUE(bench.stage.executed.empty());
  EXPECT_EQ(bench.state(), JobState::idle);
}

TEST_F(FocusCalibrationTest, WritesDownWhatItFound) {
  calibrate();
  const nlohmann::json found = record();
  EXPECT_EQ(found.at("kind"), "focus");
  EXPECT_EQ(found.at("actuator"), "column");
  EXPECT_NEAR(found.at("plane_um").get<double>(), 600.0, 4.0);
  EXPECT_THAT(found.at("position").get<std::string>(), HasSubstr(" µm"));
  EXPECT_THAT(found.at("found_at").get<std::string>(), HasSubstr("2026-11-01T"));
  EXPECT_GT(found.at("suitable_step_um").get<double>(), 1.0);
  EXPECT_DOUBLE_EQ(found.at("depth_of_field_um").get<double>(),
                   2.0 * found.at("suitable_step_um").get<double>());
  EXPECT_EQ(found.at("taken_with").at("exposure_us"), 10000);
  EXPECT_LT(std::abs(found.at("lean").at("angle_degrees").get<double>()), 5.0);
  const nlohmann::json& points = found.at("points");
  EXPECT_EQ(points.size(), static_cast<std::size_t>(bench.camera.captures));
  EXPECT_EQ(points.back().at("plane_um"), found.at("plane_um"));
  // Of the finest bracket, before the confirming frame, the middle is sharper than the ends.
  const auto sharpness_at = [&](std::size_t from_the_end) {
    return points.at(points.size() - from_the_end).at("sharpness").get<double>();
  };
  EXPECT_GT(sharpness_at(4), sharpness_at(6));
  EXPECT_GT(sharpness_at(4), sharpness_at(2));
}

TEST_F(FocusCalibrationTest, ShowsHowFarItIs) {
  bench.say(OperatorCommand::calibrate_focus);
  std::string shown;
  for (int i = 0; i < 1000 && bench.camera.captures < 3; ++i) {
    EXPECT_EQ(calibration().kind, "focus");
    bench.tick();
  }
  bench.tick();
  shown = nlohmann::json::parse(status_json(*bench.board.look(), {}))
              .at("calibration")
              .at("sentence")
              .get<std::string>();
  EXPECT_EQ(shown, "searches the focus: 3 frames");
  EXPECT_TRUE(lit());
}

TEST_F(FocusCalibrationTest, PhotographsOnlyWhenTheLampIsWarm) {
  bench.settings.plan.lamp_warm_up = std::chrono::seconds(2);
  start_daemon();
  bench.say(OperatorCommand::calibrate_focus);
  for (int i = 0; i < 1000 && !lit(); ++i) bench.tick();
  bench.tick(90);  // 1.8 s
  EXPECT_TRUE(column_targets().empty());
  bench.tick(30);
  EXPECT_FALSE(column_targets().empty());
}

TEST_F(FocusCalibrationTest, ThatFindsNothingSaysWhatToDoAndGoesBack) {
  bench.camera.column_to_face_um = -90000.0;
  bench.stage.status.interlocks.homed = true;
  bench.stage.status.column = {700.0};
  calibrate();
  EXPECT_EQ(calibration().progress, Progress::failed);
  EXPECT_THAT(calibration().sentence, HasSubstr("no focus was found around 700.0 µm of the column: "
                                                "the "));
  EXPECT_THAT(calibration().sentence, HasSubstr("focus.reach_um wider"));
  EXPECT_EQ(bench.stage.status.column.value, 700.0);
  EXPECT_FALSE(std::filesystem::exists(record_path()));
  EXPECT_FALSE(lit());
  EXPECT_EQ(bench.state(), JobState::idle) << "nothing is wrong with the rig";
}

TEST_F(FocusCalibrationTest, StaysWithinTheColumnsLimitsAndItsReach) {
  bench.camera.column_to_face_um = -90000.0;
  bench.stage.identity.column = {{200.0}, {10000.0}};
  bench.settings.focus.reach = {500.0};
  start_daemon();
  calibrate();
  std::vector<double> targets = column_targets();
  ASSERT_GT(targets.size(), 5U);
  const auto [least, most] = std::minmax_element(targets.begin(), targets.end());
  EXPECT_GE(*least, 200.0);
  EXPECT_LE(*most, 800.0);
}

TEST_F(FocusCalibrationTest, IsRefusedWhileAJobRuns) {
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
  const OperatorReply reply = bench.say(OperatorCommand::calibrate_focus);
  EXPECT_FALSE(reply.accepted);
  EXPECT_THAT(reply.sentence, HasSubstr("calibrate before it begins or after its end"));
  EXPECT_TRUE(calibration().kind.empty());
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
}

TEST_F(FocusCalibrationTest, IsRefusedWhileTheWheelTurns) {
  bench.stage.status.spindle_rpm = 300.0;
  const OperatorReply reply = bench.say(OperatorCommand::calibrate_focus);
  EXPECT_FALSE(reply.accepted);
  EXPECT_THAT(reply.sentence, HasSubstr("the wheel turns at 300 rpm"));
  EXPECT_TRUE(bench.stage.executed.empty());
}

TEST_F(FocusCalibrationTest, IsRefusedWhileTheControllerIsBusy) {
  bench.stage.status.state = bridge::ControllerState::busy;
  EXPECT_THAT(bench.say(OperatorCommand::calibrate_focus).sentence, HasSubstr("must be idle"));
  EXPECT_TRUE(bench.stage.executed.empty());
}

TEST_F(FocusCalibrationTest, OfAFaultedControllerAsksForAnAcknowledgement) {
  constexpr std::uint16_t kDoor = 2;
  bench.stage.fault(kDoor);
  EXPECT_THAT(bench.say(OperatorCommand::calibrate_focus).sentence,
              HasSubstr("the controller is faulted: door): acknowledge it first"));
  EXPECT_EQ(bench.state(), JobState::faulted);
  bench.tick(100);
  EXPECT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
  EXPECT_TRUE(calibrate().accepted);
  EXPECT_EQ(calibration().progress, Progress::done) << calibration().sentence;
}

TEST_F(FocusCalibrationTest, MovesNothingByAControllerThatDoesNotWatchTheDaemon) {
  bench.stage.identity.watchdog_timeout = std::chrono::milliseconds(0);
  calibrate();
  EXPECT_EQ(calibration().progress, Progress::failed);
  EXPECT_THAT(calibration().sentence, HasSubstr("safety.require_watchdog"));
  EXPECT_TRUE(bench.stage.executed.empty());
}

TEST_F(FocusCalibrationTest, AsksAgainWhenALineLosesTheControllersName) {
  bench.stage.unanswered_identities = 3;
  calibrate();
  EXPECT_EQ(calibration().progress, Progress::done) << calibration().sentence;
}

TEST_F(FocusCalibrationTest, WithoutACameraMovesNothing) {
  bench.camera.gone = true;
  calibrate();
  EXPECT_EQ(calibration().sentence, "camera: gone");
  EXPECT_TRUE(bench.stage.executed.empty());
  EXPECT_EQ(bench.state(), JobState::idle);
}

struct FocusCalibrationInMotion : FocusCalibrationTest, testing::WithParamInterface<StageAction> {};

TEST_P(FocusCalibrationInMotion, StopsTheStageForTheEstop) {
  calibrate_until(GetParam());
  const auto executed = bench.stage.executed.size();
  bool stopped = false;
  bench.stage.on_command = [&](const bridge::StageCommand& command) {
    stopped = stopped || command.action == StageAction::stop;
  };
  bench.stage.on_exchange = [&] { EXPECT_TRUE(stopped) << "the controller was asked first"; };
  bench.lines.inputs.estop_pressed = true;
  bench.tick();
  expect_stopped(executed, "the e-stop is pressed (line)");
  bench.tick(200);
  EXPECT_EQ(bench.stage.executed.size(), executed + 1) << "it moved after the e-stop";
}

TEST_P(FocusCalibrationInMotion, StopsTheStageForAnOpenDoor) {
  calibrate_until(GetParam());
  const auto executed = bench.stage.executed.size();
  bench.stage.status.interlocks.door_open = true;
  bench.tick();
  expect_stopped(executed, "the door is open (controller)");
}

TEST_P(FocusCalibrationInMotion, StopsTheStageWhenTheWheelTurns) {
  calibrate_until(GetParam());
  const auto executed = bench.stage.executed.size();
  bench.stage.status.spindle_rpm = 900.0;
  bench.tick();
  expect_stopped(executed, "the wheel turns at 900 rpm");
}

TEST_P(FocusCalibrationInMotion, StopsTheStageWhenItTakesTooLong) {
  bench.settings.limits.home_limit = bench.settings.limits.park_limit =
      bench.settings.limits.focus_limit = std::chrono::milliseconds(2000);
  start_daemon();
  calibrate_until(GetParam());
  const auto executed = bench.stage.executed.size();
  for (int i = 0; i < 120 && calibration().progress == Progress::running; ++i) bench.tick();
  expect_stopped(executed, "took");
  EXPECT_THAT(calibration().sentence, HasSubstr("long"));
}

TEST_P(FocusCalibrationInMotion, StopsTheStageWhenItIsAborted) {
  calibrate_until(GetParam());
  const auto executed = bench.stage.executed.size();
  EXPECT_TRUE(bench.say(OperatorCommand::abort).accepted);
  ASSERT_EQ(bench.stage.executed.size(), executed + 1);
  EXPECT_EQ(bench.stage.executed.back().command.action, StageAction::stop);
  EXPECT_EQ(calibration().progress, Progress::running) << "the stop is not yet carried out";
  bench.tick(2);
  EXPECT_EQ(calibration().progress, Progress::failed);
  EXPECT_EQ(calibration().sentence, "it was given up: abort");
  EXPECT_FALSE(lit());
  EXPECT_EQ(bench.state(), JobState::idle);
  bench.tick(5);
  EXPECT_TRUE(calibrate().accepted);
  EXPECT_EQ(calibration().progress, Progress::done) << calibration().sentence;
}

TEST_P(FocusCalibrationInMotion, IsAFaultWhenItsStopIsNotCarriedOut) {
  calibrate_until(GetParam());
  bench.stage.ignored = StageAction::stop;
  EXPECT_TRUE(bench.say(OperatorCommand::abort).accepted);
  ASSERT_TRUE(bench.reach(JobState::faulted, 300));
  EXPECT_EQ(calibration().progress, Progress::failed);
  EXPECT_THAT(bench.alarm(), HasSubstr("does not start it"));
}

TEST_P(FocusCalibrationInMotion, StopsTheStageWhenTheDaemonIsStopped) {
  calibrate_until(GetParam());
  EXPECT_TRUE(bench.say(OperatorCommand::shut_down).accepted);
  EXPECT_EQ(bench.stage.executed.back().command.action, StageAction::stop);
  bench.tick(2);
  EXPECT_EQ(calibration().progress, Progress::failed);
  EXPECT_TRUE(bench.job->at_rest());
}

std::string action_name(const testing::TestParamInfo<StageAction>& info) {
  return to_string(info.param);
}
INSTANTIATE_TEST_SUITE_P(Motions, FocusCalibrationInMotion,
                         testing::Values(StageAction::home, StageAction::retract,
                                         StageAction::move_column),
                         action_name);

TEST_F(FocusCalibrationTest, StopsTheStageWhenTheControllerFallsSilent) {
  calibrate_until(StageAction::move_column);
  bench.stage.silent = true;
  for (int i = 0; i < 200 && calibration().progress == Progress::running; ++i) bench.tick();
  EXPECT_EQ(bench.stage.handed_over.back().command.action, StageAction::stop);
  EXPECT_THAT(calibration().sentence, HasSubstr("does not answer"));
  EXPECT_EQ(bench.state(), JobState::faulted);
}

TEST_F(FocusCalibrationTest, DeliversAStopThatWasNotHeardAsSoonAsTheControllerListens) {
  calibrate_until(StageAction::move_column);
  bench.stage.lost_answer = FakeStage::LostAnswer{.action = StageAction::stop, .arrived = false};
  EXPECT_TRUE(bench.say(OperatorCommand::abort).accepted);
  bench.tick(2);
  EXPECT_EQ(bench.stage.count(StageAction::stop), 1);
  EXPECT_EQ(calibration().progress, Progress::failed);
  EXPECT_EQ(bench.state(), JobState::faulted) << "a person looks at a stage that was deaf";
}

TEST_F(FocusCalibrationTest, StopsTheStageWhenItLosesItsReference) {
  calibrate_until(StageAction::move_column);
  const auto executed = bench.stage.executed.size();
  bench.stage.status.interlocks.homed = false;
  bench.tick();
  expect_stopped(executed, "lost its reference");
}

TEST_F(FocusCalibrationTest, StopsTheStageWhenTheCameraFails) {
  bench.say(OperatorCommand::calibrate_focus);
  for (int i = 0; i < 1000 && bench.camera.captures < 3; ++i) bench.tick();
  const auto executed = bench.stage.executed.size();
  bench.camera.gone = true;
  for (int i = 0; i < 200 && calibration().progress == Progress::running; ++i) bench.tick();
  EXPECT_EQ(calibration().sentence, "camera: gone");
  EXPECT_GT(bench.stage.count(StageAction::stop), 0);
  EXPECT_GT(bench.stage.executed.size(), executed);
  EXPECT_EQ(bench.state(), JobState::faulted);
}

TEST_F(FocusCalibrationTest, SaysWhenWhatItFoundCannotBeStored) {
  std::ofstream(bench.settings.calibration.folder) << "a file, not a folder";
  calibrate();
  EXPECT_EQ(calibration().progress, Progress::failed);
  EXPECT_THAT(calibration().sentence, HasSubstr("the calibration was not stored: "));
  EXPECT_EQ(bench.state(), JobState::idle);
}

}  // namespace
}  // namespace biotomy::tests
