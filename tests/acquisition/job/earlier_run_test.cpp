// What a daemon does with a job that was running when the one before it ended.
#include "acquisition/job/earlier_run.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/job/job.hpp"
#include "firmware_bridge/device_error.hpp"
#include "tests/acquisition/job_bench.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint16_t kWatchdog = 3;
constexpr std::uint16_t kDrive = 5;
constexpr double kWarm = -2.0;
constexpr double kCold = -30.0;

std::filesystem::path journal(const JobBench& bench) {
  return bench.settings.plan.sample / "journal.sqlite";
}

TEST(EarlierRun, OfNoJournalTellsOfNothing) {
  const EarlierRun earlier = read_earlier_run("no/such/journal.sqlite");
  EXPECT_EQ(earlier.last_sequence, 0U);
  EXPECT_FALSE(earlier.was_running);
}

TEST(EarlierRun, IsReadFromTheJournalOfAnOlderProgram) {
  const TemporaryFolder folder;
  const std::filesystem::path old = folder.path() / "journal.sqlite";
  SQLite::Database(old.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("PRAGMA user_version = 0");
  EXPECT_EQ(read_earlier_run(old).last_sequence, 0U);
}

TEST(EarlierRun, WasRunningInEveryStepOfALayer) {
  JobBench bench;
  bench.start_job();
  for (const JobState state : {JobState::recovering, JobState::grinding, JobState::focusing,
                               JobState::assessing, JobState::storing}) {
    ASSERT_TRUE(bench.reach(state));
    EXPECT_TRUE(read_earlier_run(journal(bench)).was_running) << to_string(state);
  }
  EXPECT_GT(read_earlier_run(journal(bench)).last_sequence, 0U);
}

TEST(EarlierRun, WasRunningWhileItWasConditionedWithdrawnAndHeld) {
  JobBench bench;
  bench.settings.limits.temperature_resumes = true;
  bench.start_daemon();
  bench.stage.status.block_temperature_c = kWarm;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::conditioning)) << bench.alarm();
  EXPECT_TRUE(read_earlier_run(journal(bench)).was_running);
  bench.stage.status.block_temperature_c = kCold;
  ASSERT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
  bench.stage.exchanges_per_command = 6000;
  bench.tick(10);
  bench.stage.status.block_temperature_c = kWarm;
  ASSERT_TRUE(bench.reach(JobState::withdrawing)) << bench.alarm();
  bench.stage.exchanges_per_command = 2;
  EXPECT_TRUE(read_earlier_run(journal(bench)).was_running);
  ASSERT_TRUE(bench.reach(JobState::held)) << bench.alarm();
  EXPECT_TRUE(read_earlier_run(journal(bench)).was_running);
}

TEST(EarlierRun, WasRunningWhileItsVolumeWasMadeComplete) {
  JobBench bench;
  bench.settings.plan.layers = 1;
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::finishing)) << bench.alarm();
  EXPECT_TRUE(read_earlier_run(journal(bench)).was_running);
}

TEST(EarlierRun, WasNotRunningAfterAPauseAFaultAnAbortAndTheEnd) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.say(OperatorCommand::pause);
  ASSERT_TRUE(bench.reach(JobState::paused));
  EXPECT_FALSE(read_earlier_run(journal(bench)).was_running);
  bench.say(OperatorCommand::resume);
  ASSERT_TRUE(bench.reach(JobState::clearing));
  bench.lines.inputs.door_open = true;
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_FALSE(read_earlier_run(journal(bench)).was_running);
  bench.lines.inputs.door_open = false;
  bench.tick(10);
  bench.say(OperatorCommand::acknowledge);
  bench.say(OperatorCommand::abort);
  ASSERT_TRUE(bench.reach(JobState::aborted));
  EXPECT_FALSE(read_earlier_run(journal(bench)).was_running);
  bench.say(OperatorCommand::start);
  ASSERT_TRUE(bench.reach(JobState::done));
  EXPECT_FALSE(read_earlier_run(journal(bench)).was_running);
}

struct CrashedDaemon : testing::Test {
  CrashedDaemon() {
    bench.settings.plan.after_restart = JobPlan::AfterRestart::go_on;
    bench.start_daemon();
    bench.start_job();
    EXPECT_TRUE(bench.reach_committed(2)) << bench.alarm();
    EXPECT_TRUE(bench.reach(JobState::clearing));
    bench.job.reset();
    // The controller has missed the daemon's heartbeat and stopped by itself.
    bench.stage.fault(kWatchdog);
  }
  JobBench bench;
};

TEST_F(CrashedDaemon, GoesOnByItselfWhenConfiguredSo) {
  bench.start_daemon();
  EXPECT_EQ(bench.state(), JobState::faulted);
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_THAT(bench.stage.ground(), ElementsAre(1000.0, 1020.0, 1040.0, 1060.0, 1080.0));
  EXPECT_THAT(bench.events_of_kind("operator"), HasSubstr("goes on by itself after a restart"));
}

// After the power was back, before the network is: the daemon has written down its start by then.
TEST_F(CrashedDaemon, GoesOnByItselfOnceTheClockIsSet) {
  const auto right = bench.wall_clock_start;
  bench.wall_clock_start -= std::chrono::hours(1);
  bench.start_daemon();
  ASSERT_TRUE(bench.reach(JobState::preflight)) << bench.alarm();
  bench.tick(1000);
  EXPECT_EQ(bench.state(), JobState::preflight) << bench.alarm();
  EXPECT_THAT(bench.board.look()->waiting_for, HasSubstr("waits for the computer's clock"));
  bench.wall_clock_start = right;
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
}

// Nobody is to be overruled by the next daemon's start: neither a person who has looked ...
TEST_F(CrashedDaemon, DoesNotGoOnAfterAPersonHasAcknowledged) {
  bench.start_daemon();
  bench.tick(20);
  EXPECT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
  EXPECT_EQ(bench.state(), JobState::idle);
  bench.start_daemon();
  bench.tick(500);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_EQ(bench.stage.ground().size(), 3U);
}

// ... nor an alarm that came before the journal was open again.
TEST_F(CrashedDaemon, DoesNotGoOnAfterAnAlarmInThePreflight) {
  bench.camera.gone = true;
  bench.start_daemon();
  bench.tick(500);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr("camera"));
  bench.camera.gone = false;
  bench.start_daemon();
  bench.tick(500);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_EQ(bench.stage.ground().size(), 3U);
}

// What must be written first cannot be: the daemon starts all the same, for the page and the alarm.
TEST_F(CrashedDaemon, DoesNotGoOnWhenTheJournalTakesNothing) {
  SQLite::Database(journal(bench).string(), SQLite::OPEN_READWRITE)
      .exec("CREATE TRIGGER full BEFORE INSERT ON events BEGIN SELECT RAISE(FAIL, 'full'); END");
  EXPECT_NO_THROW(bench.start_daemon());
  bench.tick(500);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_EQ(bench.stage.ground().size(), 3U);
}

TEST(EarlierRun, WasNotRunningAfterAnAlarmInThePreflightOfAResumedJob) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.say(OperatorCommand::pause);
  ASSERT_TRUE(bench.reach(JobState::paused));
  bench.camera.gone = true;
  bench.say(OperatorCommand::resume);
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_FALSE(read_earlier_run(journal(bench)).was_running);
}

struct LatchThatIsReset : CrashedDaemon {
  LatchThatIsReset() {
    bench.stage.exchanges_per_command = 50;
    bench.start_daemon();
    EXPECT_TRUE(bench.reach(JobState::resetting));
  }
  void expect_that_nothing_moved() {
    bench.tick(500);
    EXPECT_TRUE(bench.job->at_rest());
    EXPECT_EQ(bench.state(), JobState::idle) << bench.alarm();
    EXPECT_EQ(bench.stage.ground().size(), 3U);
  }
};

TEST_F(LatchThatIsReset, StartsNothingInADaemonThatEnds) {
  EXPECT_TRUE(bench.say(OperatorCommand::shut_down).accepted);
  expect_that_nothing_moved();
}

TEST_F(LatchThatIsReset, StartsNothingAfterAPause) {
  EXPECT_TRUE(bench.say(OperatorCommand::pause).accepted);
  expect_that_nothing_moved();
}

TEST_F(LatchThatIsReset, StartsNothingAfterAnAbort) {
  EXPECT_TRUE(bench.say(OperatorCommand::abort).accepted);
  expect_that_nothing_moved();
}

TEST_F(CrashedDaemon, WaitsForAnOperatorWhenNotConfiguredSo) {
  bench.settings.plan.after_restart = JobPlan::AfterRestart::wait;
  bench.start_daemon();
  bench.tick(5000);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_EQ(bench.stage.ground().size(), 3U);
}

TEST_F(CrashedDaemon, WaitsForAnOperatorWhileTheDoorIsOpen) {
  bench.lines.inputs.door_open = true;
  bench.start_daemon();
  bench.tick(60 * 50 + 10);
  bench.lines.inputs.door_open = false;
  bench.tick(1000);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr("did not go on by itself"));
  EXPECT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
  EXPECT_EQ(bench.state(), JobState::idle);
}

TEST_F(CrashedDaemon, WaitsForAnOperatorOnceTheDoorWasOpen) {
  bench.start_daemon();
  bench.tick(10);
  bench.lines.inputs.door_open = true;
  bench.tick(1);
  bench.lines.inputs.door_open = false;
  bench.tick(500);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr("since the door is open"));
}

TEST(EarlierRun, TellsOfAnAlarmThatNobodyAcknowledged) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(2)) << bench.alarm();
  bench.stage.status.vibration_mm_s = 12.0;
  ASSERT_TRUE(bench.reach(JobState::faulted));
  bench.stage.status.vibration_mm_s = 0.0;
  bench.tick(50);
  EXPECT_THAT(read_earlier_run(journal(bench)).alarm, HasSubstr("the spindle vibrates"));

  bench.start_daemon();
  bench.tick(3);
  EXPECT_THAT(bench.alarm(), HasSubstr("the spindle vibrates"));
  EXPECT_EQ(bench.board.look()->committed, bench.count_rows("layers")) << "known from the start";
  EXPECT_THAT(bench.say(OperatorCommand::start).sentence, HasSubstr("acknowledge it first"));
  EXPECT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(read_earlier_run(journal(bench)).alarm, "");
}

TEST_F(CrashedDaemon, WaitsForAnOperatorWhenTheControllerHasAnotherFault) {
  bench.stage.fault(kDrive);
  bench.start_daemon();
  bench.tick(500);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr("the controller is faulted: a drive"));
}

TEST_F(CrashedDaemon, LeavesItToTheOperatorWhoSpeaksFirst) {
  bench.start_daemon();
  bench.say(OperatorCommand::pause);
  bench.tick(1000);
  EXPECT_EQ(bench.state(), JobState::faulted);
}

TEST_F(CrashedDaemon, IsFaultedWhenTheControllerDoesNotTakeTheReset) {
  bench.stage.on_command = [](const bridge::StageCommand& command) {
    if (command.action != bridge::StageAction::reset_fault) return;
    throw bridge::DeviceError(bridge::DeviceError::Kind::refused, "stage: no such command");
  };
  bench.start_daemon();
  EXPECT_NO_THROW(bench.tick(500));
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr("no such command"));
}

TEST_F(CrashedDaemon, StopsWhenJournalAndControllerDisagree) {
  ++bench.stage.status.grind_count;
  bench.start_daemon();
  bench.tick(500);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr("disagrees with the controller"));
  EXPECT_EQ(bench.stage.ground().size(), 3U);
}

// What it finds is idle or faulted, hence halted: only what is at work goes without a heartbeat.
TEST_F(CrashedDaemon, GivesItsHeartbeatToAControllerThatStaysFaulted) {
  bench.stage.fault(kDrive);
  bench.start_daemon();
  bench.stage.heartbeats.clear();
  bench.tick(50);
  EXPECT_EQ(bench.stage.status.state, bridge::ControllerState::faulted);
  EXPECT_EQ(bench.stage.heartbeats.size(), 50U);
}

TEST_F(CrashedDaemon, WaitsForAnOperatorWhenTheRigIsNotReadyWithinFiveMinutes) {
  bench.stage.silent = true;
  bench.start_daemon();
  bench.tick(5 * 60 * 50 + 10);
  EXPECT_THAT(bench.alarm(), HasSubstr("the rig was not ready within 5 min"));
  bench.stage.silent = false;
  bench.tick(500);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_EQ(bench.stage.ground().size(), 3U);
}

TEST_F(CrashedDaemon, GoesOnByItselfWhenTheLinkComesUpWithinFiveMinutes) {
  bench.stage.silent = true;
  bench.start_daemon();
  bench.tick(4 * 60 * 50);
  bench.stage.silent = false;
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
}

TEST_F(CrashedDaemon, WaitsForTwoGoodSecondsOnEnd) {
  bench.start_daemon();
  bench.tick(90);
  bench.stage.status.spindle_rpm = 100.0;
  bench.tick();
  bench.stage.status.spindle_rpm = 0.0;
  bench.tick(90);
  EXPECT_EQ(bench.state(), JobState::faulted);
  bench.tick(20);
  EXPECT_NE(bench.state(), JobState::faulted) << bench.alarm();
}

TEST_F(CrashedDaemon, WaitsForAControllerThatBoots) {
  bench.stage.status.state = bridge::ControllerState::booting;
  bench.stage.status.interlocks.watchdog_tripped = false;
  bench.start_daemon();
  bench.tick(500);
  EXPECT_EQ(bench.state(), JobState::faulted) << bench.alarm();
  bench.stage.status.state = bridge::ControllerState::idle;
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
}

}  // namespace
}  // namespace biotomy::tests
