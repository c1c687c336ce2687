#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/job/job.hpp"
#include "firmware_bridge/device_error.hpp"
#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using bridge::StageAction;
using testing::HasSubstr;
using testing::Not;

constexpr std::uint16_t kWatchdog = 3;

const std::vector<JobState> kSteps = {
    JobState::recovering, JobState::homing,    JobState::grinding, JobState::retracting,
    JobState::clearing,   JobState::settling,  JobState::lighting, JobState::focusing,
    JobState::capturing,  JobState::assessing, JobState::storing,  JobState::finishing};

class JobInEveryState : public testing::TestWithParam<JobState> {};

TEST_P(JobInEveryState, StopsTheWheelWhenTheEstopIsPressed) {
  JobBench bench;
  bench.settings.plan.layers = 1;
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(GetParam())) << to_string(bench.state());
  const auto executed = bench.stage.executed.size();
  bench.lines.inputs.estop_pressed = true;
  bench.tick();
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr("e-stop"));
  ASSERT_GT(bench.stage.executed.size(), executed);
  EXPECT_EQ(bench.stage.executed[executed].command.action, StageAction::stop);
  EXPECT_FALSE(bench.lines.on.contains(bridge::OutputRole::lamp));
  EXPECT_TRUE(bench.lines.on.contains(bridge::OutputRole::tower_light));

  // Nothing moves any more, whatever is said, until the e-stop is out and acknowledged.
  EXPECT_FALSE(bench.say(OperatorCommand::resume).accepted);
  EXPECT_THAT(bench.say(OperatorCommand::acknowledge).sentence, HasSubstr("still there"));
  bench.tick(200);
  EXPECT_EQ(bench.stage.executed.size(), executed + 1);
  bench.lines.inputs.estop_pressed = false;
  bench.tick(200);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
  EXPECT_EQ(bench.state(), JobState::paused);
  EXPECT_TRUE(bench.say(OperatorCommand::resume).accepted);
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("layers"), 1);
  EXPECT_EQ(bench.released_by_control, 0) << "the control thread would have waited for the disk";
}

std::string state_name(const testing::TestParamInfo<JobState>& info) {
  return to_string(info.param);
}
INSTANTIATE_TEST_SUITE_P(Steps, JobInEveryState, testing::ValuesIn(kSteps), state_name);

/// Runs to the grinding of layer 1, breaks something, and expects the rig to stop for that.
void expect_stop(const std::function<void(JobBench&)>& breakage, const std::string& cause) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  breakage(bench);
  ASSERT_TRUE(bench.reach(JobState::faulted, 1000)) << cause;
  EXPECT_THAT(bench.alarm(), HasSubstr(cause));
  EXPECT_LE(bench.stage.ground().size(), 1U);
}

TEST(JobSafety, StopsForAnOpenDoor) {
  expect_stop([](JobBench& bench) { bench.lines.inputs.door_open = true; }, "door is open (line)");
}

TEST(JobSafety, StopsForTheControllersOwnInterlocks) {
  expect_stop([](JobBench& bench) { bench.stage.status.interlocks.door_open = true; },
              "door is open (controller)");
  expect_stop([](JobBench& bench) { bench.stage.status.interlocks.watchdog_tripped = true; },
              "watchdog");
}

TEST(JobSafety, StopsWhenTheControllerFallsSilent) {
  expect_stop([](JobBench& bench) { bench.stage.silent = true; }, "does not answer");
}

TEST(JobSafety, StopsWhenTheControllersHeartStandsStill) {
  expect_stop(
      [](JobBench& bench) {
        bench.stage.heart_stopped = true;
        bench.stage.exchanges_per_command = 1000000;
      },
      "heartbeat stands still");
}

TEST(JobSafety, StopsWhenTheBlockGetsWarm) {
  expect_stop(
      [](JobBench& bench) {
        bench.stage.status.block_temperature_c = -1.0;
        bench.stage.exchanges_per_command = 1000000;
      },
      "the block is at -1.0");
}

TEST(JobSafety, StopsWhenTheControllerLosesItsReference) {
  expect_stop([](JobBench& bench) { bench.stage.status.interlocks.homed = false; },
              "the controller lost its reference");
}

TEST(JobSafety, StopsWhenTheLinesCannotBeRead) {
  expect_stop([](JobBench& bench) { bench.lines.inputs.failure = "no such chip"; },
              "e-stop and door cannot be read: no such chip");
}

TEST(JobSafety, StopsWhenTheFeedIsNotWhereItShouldBe) {
  expect_stop([](JobBench& bench) { bench.stage.feed_error_um = 30.0; },
              "the feed is at 1030.0 µm and should be at 1000.0 µm");
}

TEST(JobSafety, StopsWhenAnAxisStandsStillOnItsWay) {
  JobBench bench;
  bench.settings.limits.axis_stall = std::chrono::milliseconds(2000);
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.stage.exchanges_per_command = 1000000;
  ASSERT_TRUE(bench.reach(JobState::faulted, 200));
  EXPECT_THAT(bench.alarm(), HasSubstr("stands still at"));
}

TEST(JobSafety, StopsWhenTheColumnSinksBetweenTwoMoves) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::assessing));
  bench.stage.status.column.value -= 20.0;
  ASSERT_TRUE(bench.reach(JobState::faulted, 3));
  EXPECT_THAT(bench.alarm(), HasSubstr("the column moves by itself"));
}

TEST(JobSafety, TellsWhenOnlyOneOfTwoContactsSeesASwitch) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.lines.inputs.estop_pressed = true;
  bench.tick(50);
  EXPECT_THAT(bench.alarm(), Not(HasSubstr("only")));
  bench.tick(100);
  EXPECT_THAT(bench.alarm(), HasSubstr("; only the line sees the e-stop pressed"));
  EXPECT_THAT(bench.events_of_kind("alarm"), HasSubstr("the controller's contact is dead"));
}

TEST(JobSafety, TellsAtRestTooWhenOnlyOneOfTwoContactsSeesADoor) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  bench.stage.status.interlocks.door_open = true;
  bench.tick(150);
  EXPECT_THAT(bench.events_of_kind("recovery"),
              HasSubstr("only the controller sees the door open"));
  EXPECT_EQ(bench.state(), JobState::done);
}

TEST(JobSafety, TellsThatTheRigCouldNotBeParked) {
  JobBench bench;
  bench.settings.limits.park_limit = std::chrono::milliseconds(2000);
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::retracting)) << bench.alarm();
  bench.stage.wheel_runs_on = true;
  bench.stage.status.vibration_mm_s = 12.0;
  ASSERT_TRUE(bench.reach(JobState::faulted));
  int beats = 0;
  bench.stage.on_exchange = [&beats] { ++beats; };
  bench.tick(200);
  EXPECT_THAT(bench.alarm(), HasSubstr("the rig could not be parked: "));
  EXPECT_THAT(bench.alarm(), HasSubstr("turns at 1500 rpm"));
  EXPECT_THAT(bench.alarm(), HasSubstr("the controller's watchdog is left to stop the wheel"));
  const int so_far = beats;
  bench.tick(10);
  EXPECT_EQ(beats, so_far) << "the heartbeat is withheld";
}

TEST(JobSafety, SendsTheStopAlsoWithoutAViewOfTheController) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
  bench.stage.exchanges_per_command = 1000000;
  bench.stage.blind = true;
  bench.stage.lost_answer = {bridge::StageAction::stop, false};
  ASSERT_TRUE(bench.reach(JobState::faulted)) << "the link counts as lost";
  bench.tick(60);
  EXPECT_EQ(bench.stage.count(bridge::StageAction::stop), 1) << "the second one arrived";
  bench.tick(200);
  int beats = 0;
  bench.stage.on_exchange = [&beats] { ++beats; };
  bench.tick(20);
  EXPECT_EQ(beats, 0) << "what is not seen to stop is left to the watchdog";
  EXPECT_THAT(bench.alarm(), HasSubstr("the stop is not confirmed"));
}

TEST(JobSafety, StopsForAnOverloadedSpindleAndForOneThatShakes) {
  expect_stop(
      [](JobBench& bench) {
        bench.stage.status.spindle_load_percent = 99.0;
        bench.stage.exchanges_per_command = 1000000;
      },
      "the spindle's load is 99.0 %");
  expect_stop(
      [](JobBench& bench) {
        bench.stage.status.vibration_mm_s = 12.0;
        bench.stage.exchanges_per_command = 1000000;
      },
      "the spindle vibrates by 12.0 mm/s");
}

TEST(JobSafety, HearsTheEstopBeforeItAsksTheController) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bool stopped = false;
  bench.stage.on_command = [&](const bridge::StageCommand& command) {
    stopped = stopped || command.action == StageAction::stop;
  };
  bench.stage.on_exchange = [&] { EXPECT_TRUE(stopped) << "the controller was asked first"; };
  bench.lines.inputs.estop_pressed = true;
  bench.tick();
  EXPECT_TRUE(stopped);
}

TEST(JobSafety, StopsWhenTheCameraDoesNotAnswer) {
  expect_stop([](JobBench& bench) { bench.camera.gone = true; }, "camera: gone");
}

TEST(JobSafety, StopsWhenAStepTakesTooLong) {
  JobBench bench;
  bench.settings.limits.grind_limit = std::chrono::milliseconds(2000);
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.stage.exchanges_per_command = 1000000;
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_THAT(bench.alarm(), HasSubstr("grinding took longer than 2000 ms"));
  EXPECT_THAT(bench.alarm(), HasSubstr("waits for the wheel"));
}

TEST(JobSafety, StopsBeforeTheDiskIsFull) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  bench.free_bytes = 10;
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_THAT(bench.alarm(), HasSubstr("disk_reserve_layers"));
  EXPECT_EQ(bench.count_rows("layers"), 2);  // the layer in work is safe
  EXPECT_EQ(bench.stage.ground().size(), 2U);
}

TEST(JobSafety, RetractsAfterAnAlarmOfItsOwnWhenTheControllerListens) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::clearing));
  const int retracted = bench.stage.count(StageAction::retract);
  bench.camera.gone = true;
  ASSERT_TRUE(bench.reach(JobState::faulted));
  bench.tick(100);
  EXPECT_EQ(bench.stage.count(StageAction::retract), retracted + 1);
  EXPECT_TRUE(bench.job->at_rest());
}

TEST(JobSafety, DeliversTheStopAsSoonAsASilentControllerListensAgain) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.stage.silent = true;
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_EQ(bench.stage.count(StageAction::stop), 0);
  bench.stage.silent = false;
  bench.tick(2);
  EXPECT_EQ(bench.stage.count(StageAction::stop), 1);
}

TEST(JobSafety, AsksTheControllerAgainWhatItIsWhenTheAnswerWasLost) {
  JobBench bench;
  bench.stage.unanswered_identities = 5;
  bench.start_job();
  EXPECT_TRUE(bench.reach(JobState::grinding));
  EXPECT_EQ(bench.stage.unanswered_identities, 0);
}

TEST(JobSafety, BeginsFaultedAndTouchesNothingUntilAPersonSaysSo) {
  JobBench bench;
  bench.tick(500);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_TRUE(bench.stage.handed_over.empty());
  EXPECT_FALSE(bench.say(OperatorCommand::resume).accepted);
  EXPECT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
  EXPECT_EQ(bench.state(), JobState::idle);
  EXPECT_EQ(bench.alarm(), "");
}

TEST(JobSafety, KeepsAStartUntilAControllerThatMissedATickAnswers) {
  JobBench bench;
  bench.stage.silent = true;
  auto reply = bench.desk.post(OperatorCommand::start, "");
  bench.tick();
  EXPECT_FALSE(is_ready(reply));
  bench.stage.silent = false;
  for (int i = 0; i < 100 && !is_ready(reply); ++i) bench.tick();
  ASSERT_TRUE(is_ready(reply));
  EXPECT_TRUE(reply.get().accepted);
}

TEST(JobSafety, TurnsAStartAwayWhenTheControllerStaysSilent) {
  JobBench bench;
  bench.stage.silent = true;
  const OperatorReply reply = bench.say(OperatorCommand::start);
  EXPECT_FALSE(reply.accepted);
  EXPECT_THAT(reply.sentence, HasSubstr("does not answer"));
}

TEST(JobSafety, SaysWhyAnAlarmCannotBeAcknowledgedYet) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.lines.inputs.door_open = true;
  bench.tick(300);
  ASSERT_EQ(bench.state(), JobState::faulted);
  const auto shut = bench.board.look();
  EXPECT_THAT(shut->waiting_for, HasSubstr("acknowledge: the cause is still there: the door"));
  EXPECT_THAT(shut->commands, testing::IsEmpty());
  bench.lines.inputs.door_open = false;
  bench.tick();
  EXPECT_EQ(bench.board.look()->waiting_for, "waits for an operator to acknowledge");
  EXPECT_THAT(bench.board.look()->commands, testing::ElementsAre(OperatorCommand::acknowledge));
}

TEST(JobSafety, DoesNotTakeStartForTheAcknowledgementOfARealAlarm) {
  JobBench bench;
  bench.stage.fault(kWatchdog);
  bench.tick();
  EXPECT_THAT(bench.say(OperatorCommand::start).sentence, HasSubstr("acknowledge it first"));
  EXPECT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
  EXPECT_EQ(bench.stage.count(StageAction::reset_fault), 1);
  EXPECT_EQ(bench.state(), JobState::idle);
}

TEST(JobSafety, KeepsTheRecordOfAFrameThatAnAlarmOvertook) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::assessing));
  bench.lines.inputs.door_open = true;
  bench.tick();
  ASSERT_EQ(bench.state(), JobState::faulted);
  EXPECT_EQ(bench.count_rows("attempts", "slug = 'abandoned'"), 1);
}

/// A controller that answers and does not stop, at the grinding of layer 1.
struct JobThatIsNotStopped : testing::Test {
  JobThatIsNotStopped() {
    bench.start_job();
    bench.stage.on_exchange = [this] { ++heartbeats; };
  }
  void reach_grinding() {
    bench.stage.on_command = [this](const bridge::StageCommand& command) {
      if (command.action == StageAction::grind_pass) bench.stage.exchanges_per_command = 1000000;
    };
    while (bench.stage.ground().empty()) bench.tick();
    bench.stage.on_command = [](const auto&) {};
  }
  void press_and_release_the_estop() {
    bench.lines.inputs.estop_pressed = true;
    bench.tick();
    bench.lines.inputs.estop_pressed = false;
  }
  void expect_that_the_watchdog_is_left_to_stop_it() {
    bench.tick(200);
    EXPECT_THAT(bench.alarm(), HasSubstr("the stop is not confirmed"));
    EXPECT_THAT(bench.events_of_kind("alarm"), HasSubstr("the stop is not confirmed"));
    const int before = heartbeats;
    bench.tick(100);
    EXPECT_EQ(heartbeats, before);
  }
  JobBench bench;
  int heartbeats = 0;
};

TEST_F(JobThatIsNotStopped, IsLeftToTheWatchdogWhenTheStopIsNotTaken) {
  reach_grinding();
  bench.stage.on_command = [](const bridge::StageCommand& command) {
    if (command.action != StageAction::stop) return;
    throw bridge::DeviceError(bridge::DeviceError::Kind::refused, "stage: no such command");
  };
  press_and_release_the_estop();
  expect_that_the_watchdog_is_left_to_stop_it();

  // Which it did; a person has looked.
  bench.stage.on_command = [](const auto&) {};
  bench.stage.fault(kWatchdog);
  bench.tick(10);
  bench.stage.exchanges_per_command = 2;
  EXPECT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
  const int before = heartbeats;
  bench.tick(10);
  EXPECT_EQ(heartbeats, before + 10);
  EXPECT_EQ(bench.state(), JobState::paused) << bench.alarm();
}

TEST_F(JobThatIsNotStopped, IsLeftToTheWatchdogWhenTheStopIsTakenAndNotStarted) {
  reach_grinding();
  bench.stage.ignored = StageAction::stop;
  press_and_release_the_estop();
  expect_that_the_watchdog_is_left_to_stop_it();
}

TEST_F(JobThatIsNotStopped, IsNotLeftToTheWatchdogWhenItStops) {
  reach_grinding();
  press_and_release_the_estop();
  bench.tick(200);
  EXPECT_THAT(bench.alarm(), Not(HasSubstr("the stop is not confirmed")));
  const int before = heartbeats;
  bench.tick(10);
  EXPECT_EQ(heartbeats, before + 10);
}

// Only the line sees the door: the controller would go on with its retract.
TEST_F(JobThatIsNotStopped, IsStoppedAgainWhenTheDoorOpensWhileItIsParked) {
  reach_grinding();
  const int retracts = bench.stage.count(StageAction::retract);
  bench.stage.status.interlocks.homed = false;
  for (int i = 0; i < 100 && bench.stage.count(StageAction::retract) == retracts; ++i) bench.tick();
  ASSERT_GT(bench.stage.count(StageAction::retract), retracts);
  const int stops = bench.stage.count(StageAction::stop);
  bench.lines.inputs.door_open = true;
  bench.tick();
  EXPECT_EQ(bench.stage.count(StageAction::stop), stops + 1);
  EXPECT_THAT(bench.events_of_kind("alarm"), HasSubstr("the parking was broken off"));
  bench.tick(10);
  EXPECT_EQ(bench.stage.count(StageAction::stop), stops + 1) << "once is enough";
  EXPECT_TRUE(bench.job->at_rest());
}

TEST(JobSafety, RefusesAControllerWithoutAWatchdog) {
  JobBench bench;
  bench.stage.identity.watchdog_timeout = {};
  bench.start_job();
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr("watchdog_timeout is 0"));
  EXPECT_EQ(bench.stage.ground().size(), 0U);
}

TEST(JobSafety, RefusesAJobThatLeavesTheFeedsLimits) {
  JobBench bench;
  bench.stage.identity.feed.maximum = {1050.0};
  bench.start_job();
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr("layer 5 would be at 1080 µm of the feed"));
  EXPECT_FALSE(std::filesystem::exists(bench.settings.plan.sample));
}

}  // namespace
}  // namespace biotomy::tests
