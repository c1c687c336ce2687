#include "acquisition/service/notifications/run_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::minutes;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A run that is shown to the watch tick by tick; what the watch says is kept as
/// "kind", or "kind over", and a text.
struct RunWatchTest : testing::Test {
  WatchLimits limits;
  std::optional<std::string> interrupted;
  std::optional<RunWatch> watch;
  JobStatus status;
  TimePoint now{std::chrono::hours(1)};
  std::vector<std::string> kinds;
  std::string text;  ///< of the last notice

  void look() {
    if (!watch) {
      watch.emplace(limits, interrupted, [] { return std::chrono::system_clock::time_point(); });
    }
    for (const Notice& notice : watch->observe(status, now)) {
      kinds.push_back(std::string(to_string(notice.kind)) + (notice.over ? " over" : ""));
      text = notice.text;
    }
  }

  void go(JobState state) {
    status.state = state;
    look();
  }

  /// From the daemon's start to a run that is grinding.
  void start_run() {
    status.alarm = Alarm{"the daemon has just started", "2026-11-26T20:00:00.000Z"};
    status.layers = 1000;
    go(JobState::faulted);
    go(JobState::resetting);
    status.alarm.reset();
    go(JobState::idle);
    go(JobState::preflight);
    go(JobState::grinding);
  }

  void fault(const std::string& cause, const std::string& since) {
    status.alarm = Alarm{cause, since};
    go(JobState::faulted);
  }

  void store_layer_after(seconds time) {
    now += time;
    ++status.committed;
    go(JobState::grinding);
  }
};

TEST_F(RunWatchTest, SaysNothingOfAnOrdinaryRunButItsEnd) {
  start_run();
  for (int i = 0; i < 5; ++i) store_layer_after(seconds(30));
  status.committed = status.layers;
  go(JobState::finishing);
  EXPECT_THAT(kinds, IsEmpty());
  go(JobState::done);
  look();
  EXPECT_THAT(kinds, ElementsAre("done"));
  EXPECT_THAT(text, HasSubstr("1000 of 1000 layers are stored"));
}

TEST_F(RunWatchTest, TellsAFaultAndItsEnd) {
  start_run();
  fault("the door is open (line)", "2026-11-26T21:00:00.000Z");
  look();
  EXPECT_THAT(kinds, ElementsAre("fault"));
  EXPECT_THAT(text, HasSubstr("the door is open (line)"));
  go(JobState::resetting);
  status.alarm.reset();
  go(JobState::paused);
  EXPECT_THAT(kinds, ElementsAre("fault", "fault over"));
}

TEST_F(RunWatchTest, TellsASecondFaultBeforeTheFirstIsOver) {
  start_run();
  fault("the door is open (line)", "2026-11-26T21:00:00.000Z");
  go(JobState::resetting);
  fault("the e-stop is pressed (line)", "2026-11-26T21:01:00.000Z");
  EXPECT_THAT(kinds, ElementsAre("fault", "fault"));
}

TEST_F(RunWatchTest, TellsAPauseThatNobodyAskedFor) {
  start_run();
  status.pause_cause = "no frame of layer 7 was good enough";
  go(JobState::pausing);
  EXPECT_THAT(text, HasSubstr("no frame of layer 7 was good enough"));
  go(JobState::paused);
  look();
  go(JobState::preflight);
  EXPECT_THAT(kinds, ElementsAre("pause", "pause over"));
}

TEST_F(RunWatchTest, DoesNotTellAPauseThatAnOperatorAskedFor) {
  start_run();
  status.pause_requested = true;
  go(JobState::capturing);
  go(JobState::pausing);
  status.pause_requested = false;
  go(JobState::paused);
  go(JobState::preflight);
  EXPECT_THAT(kinds, IsEmpty());
}

TEST_F(RunWatchTest, TellsWhenAJobIsHeldAndWhenItGoesOn) {
  start_run();
  status.pause_cause = "the block is at -3.0 °C";
  go(JobState::withdrawing);
  EXPECT_THAT(text, HasSubstr("the block is at -3.0 °C"));
  go(JobState::held);
  now += minutes(600);
  look();
  go(JobState::preflight);
  EXPECT_THAT(kinds, ElementsAre("pause", "pause over"));
}

TEST_F(RunWatchTest, DoesNotTakeTheWaitAfterAnAcknowledgementForAPause) {
  start_run();
  fault("the door is open (line)", "2026-11-26T21:00:00.000Z");
  kinds.clear();
  status.alarm.reset();
  go(JobState::paused);
  EXPECT_THAT(kinds, ElementsAre("fault over"));
}

TEST_F(RunWatchTest, TellsALowDiskOnceAndWhenThereIsRoomAgain) {
  limits.low_disk_layers = 100;
  status.disk_left_layers = 5000;
  start_run();
  for (const std::int64_t left : {101, 99, 98, 101, 105, 50}) {
    status.disk_left_layers = left;
    look();
  }
  EXPECT_THAT(kinds, ElementsAre("low_disk"));
  status.disk_left_layers = 2000;
  look();
  EXPECT_THAT(kinds, ElementsAre("low_disk", "low_disk over"));
}

TEST_F(RunWatchTest, DoesNotMindADiskThatHoldsWhatIsStillToCome) {
  limits.low_disk_layers = 100;
  start_run();
  status.committed = 960;
  status.disk_left_layers = 45;
  look();
  EXPECT_THAT(kinds, IsEmpty());
}

TEST_F(RunWatchTest, MeasuresAStallByTheRunsOwnPace) {
  limits.stall_factor = 3.0;
  limits.stall_minimum = seconds(10);
  start_run();
  for (int i = 0; i < 5; ++i) store_layer_after(seconds(30));
  now += seconds(90);
  look();
  EXPECT_THAT(kinds, IsEmpty());
  now += seconds(1);
  status.waiting_for = "waits for the wheel";
  look();
  look();
  EXPECT_THAT(kinds, ElementsAre("stalled"));
  EXPECT_THAT(text, testing::AllOf(HasSubstr("91 s"), HasSubstr("waits for the wheel")));
  store_layer_after(seconds(10));
  EXPECT_THAT(kinds, ElementsAre("stalled", "stalled over"));
}

TEST_F(RunWatchTest, GivesARunWithoutAPaceItsOwnLimit) {
  limits.stall_first = minutes(30);
  start_run();
  now += minutes(30);
  look();
  store_layer_after(seconds(0));  // the first layer says nothing of the pace: it began with checks
  now += minutes(30);
  look();
  EXPECT_THAT(kinds, IsEmpty());
  now += seconds(1);
  look();
  EXPECT_THAT(kinds, ElementsAre("stalled"));
}

TEST_F(RunWatchTest, DoesNotTakeTheWaitForAColdBlockForAStall) {
  limits.stall_factor = 2.0;
  limits.stall_minimum = seconds(1);
  start_run();
  for (int i = 0; i < 3; ++i) store_layer_after(seconds(10));
  go(JobState::conditioning);
  now += minutes(600);
  look();
  go(JobState::grinding);
  now += seconds(15);
  look();
  EXPECT_THAT(kinds, IsEmpty());
}

TEST_F(RunWatchTest, DoesNotTakeAPauseForAStall) {
  limits.stall_factor = 2.0;
  limits.stall_minimum = seconds(1);
  start_run();
  for (int i = 0; i < 3; ++i) store_layer_after(seconds(10));
  status.pause_requested = true;
  go(JobState::pausing);
  go(JobState::paused);
  now += minutes(600);
  look();
  status.pause_requested = false;
  go(JobState::preflight);
  now += seconds(15);
  go(JobState::grinding);
  EXPECT_THAT(kinds, IsEmpty());
}

TEST_F(RunWatchTest, TellsThatTheLastDaemonEndedWhileTheRigWorked) {
  interrupted = "the job knee-042, since 2026-11-26T20:00:00.000Z";
  status.alarm = Alarm{"the daemon has just started", "2026-11-26T21:00:00.000Z"};
  go(JobState::faulted);
  EXPECT_THAT(kinds, ElementsAre("interrupted"));
  EXPECT_THAT(text, HasSubstr("the job knee-042"));
  status.alarm.reset();
  go(JobState::idle);
  go(JobState::preflight);
  EXPECT_THAT(kinds, ElementsAre("interrupted", "interrupted over"));
}

}  // namespace
}  // namespace biotomy::tests
