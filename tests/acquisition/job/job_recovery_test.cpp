#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/job/job.hpp"
#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using bridge::StageAction;
using testing::ElementsAre;
using testing::HasSubstr;

/// The daemon dies in the state, starts again, and the operator starts the job.
void die_in(JobBench& bench, JobState state, int layer) {
  bench.start_job();
  while (bench.board.look()->layer < layer) bench.tick();
  ASSERT_TRUE(bench.reach(state));
}

void restart(JobBench& bench) {
  bench.start_daemon();
  bench.tick(20);  // what the controller had begun comes to its end
  bench.start_job();
}

class JobAfterARestart : public testing::TestWithParam<JobState> {};

TEST_P(JobAfterARestart, GrindsEveryLayerExactlyOnce) {
  JobBench bench;
  die_in(bench, GetParam(), 3);
  restart(bench);
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_THAT(bench.stage.ground(), ElementsAre(1000.0, 1020.0, 1040.0, 1060.0, 1080.0));
  EXPECT_EQ(bench.count_rows("layers"), 5);
  EXPECT_EQ(bench.count_rows("grinds", "result = 'done'"), 5);
}

std::string state_name(const testing::TestParamInfo<JobState>& info) {
  return to_string(info.param);
}
INSTANTIATE_TEST_SUITE_P(Steps, JobAfterARestart,
                         testing::Values(JobState::retracting, JobState::clearing,
                                         JobState::focusing, JobState::capturing,
                                         JobState::assessing),
                         state_name);

TEST(JobRecovery, PhotographsWithoutGrindingWhenThePassEndedUnseen) {
  JobBench bench;
  die_in(bench, JobState::grinding, 3);
  while (bench.stage.ground().size() < 3) bench.tick();  // the pass has begun
  while (bench.stage.status.state == bridge::ControllerState::busy) bench.stage.look();
  restart(bench);
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.stage.ground().size(), 5U);
  EXPECT_EQ(bench.count_rows("grinds", "result = 'done'"), 5) << "its end is written down";
}

TEST(JobRecovery, StopsAPassThatItFindsUnderWayAndRepeatsIt) {
  JobBench bench;
  die_in(bench, JobState::grinding, 3);
  while (bench.stage.ground().size() < 3) bench.tick();
  bench.stage.exchanges_per_command = 1000;
  int beats = 0;
  bench.stage.on_exchange = [&beats] { ++beats; };
  bench.start_daemon();
  bench.tick();
  EXPECT_EQ(beats, 0) << "the watchdog of a wheel that it did not start is not fed";
  EXPECT_EQ(bench.stage.executed.back().command.action, bridge::StageAction::stop);
  EXPECT_THAT(bench.alarm(), HasSubstr("the rig was found at work and is stopped"));
  bench.stage.exchanges_per_command = 2;
  bench.tick(5);
  EXPECT_GT(beats, 0);
  bench.stage.on_exchange = [] {};
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_THAT(bench.stage.ground(), ElementsAre(1000.0, 1020.0, 1040.0, 1040.0, 1060.0, 1080.0));
}

TEST(JobRecovery, LeavesAControllerAloneThatHaltsByItself) {
  for (const auto state : {bridge::ControllerState::booting, bridge::ControllerState::faulted}) {
    JobBench bench;
    bench.stage.status.state = state;
    bench.stage.status.spindle_rpm = 700.0;  // it runs down
    bench.start_daemon();
    bench.tick(10);
    EXPECT_EQ(bench.stage.count(bridge::StageAction::stop), 0);
    bench.stage.status.state = bridge::ControllerState::idle;
    bench.stage.status.spindle_rpm = 0.0;
    bench.tick(10);
    EXPECT_EQ(bench.stage.count(bridge::StageAction::stop), 0);
  }
}

TEST(JobRecovery, StopsAWheelThatItFindsTurning) {
  JobBench bench;
  bench.stage.status.spindle_rpm = 1500.0;
  bench.stage.wheel_runs_on = true;
  bench.start_daemon();
  int beats = 0;
  bench.stage.on_exchange = [&beats] { ++beats; };
  bench.tick(50);
  EXPECT_EQ(beats, 0);
  EXPECT_EQ(bench.stage.count(bridge::StageAction::stop), 1);
  EXPECT_THAT(bench.say(OperatorCommand::acknowledge).sentence,
              HasSubstr("the wheel still turns, at 1500 rpm"));
  bench.stage.status.spindle_rpm = 0.0;
  bench.stage.wheel_runs_on = false;
  bench.tick(2);
  EXPECT_GT(beats, 0);
  EXPECT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
}

TEST(JobRecovery, StopsWhenTheControllerHasGroundFurtherThanTheJournalKnows) {
  JobBench bench;
  die_in(bench, JobState::clearing, 3);
  bench.stage.status.ground_to = {1100.0};
  ++bench.stage.status.grind_count;
  restart(bench);
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_THAT(bench.alarm(), HasSubstr("disagrees with the controller"));
  EXPECT_EQ(bench.stage.ground().size(), 3U);
}

TEST(JobRecovery, StopsWhenACommittedLayersFileIsMissing) {
  JobBench bench;
  die_in(bench, JobState::clearing, 3);
  std::filesystem::remove(bench.settings.plan.sample / "layers/000001.tif");
  restart(bench);
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_THAT(bench.alarm(), HasSubstr("layer 1 is committed in the journal but its file"));
}

TEST(JobRecovery, StopsWhenACommittedLayersFileHasAnotherSize) {
  JobBench bench;
  die_in(bench, JobState::clearing, 3);
  std::filesystem::resize_file(bench.settings.plan.sample / "layers/000002.tif", 1);
  restart(bench);
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_THAT(bench.alarm(), HasSubstr("has 1 bytes"));
}

TEST(JobRecovery, RefusesASampleOfAnotherSpacing) {
  JobBench bench;
  die_in(bench, JobState::clearing, 2);
  bench.settings.plan.pixel_x = {11.0};
  restart(bench);
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_THAT(bench.alarm(), HasSubstr("another spacing"));
}

TEST(JobIssuing, ReadsBackAnUnansweredGrindThatWasStartedAndDoesNotRepeatIt) {
  JobBench bench;
  bench.stage.lost_answer = {StageAction::grind_pass, true};
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.stage.ground().size(), 5U);
  EXPECT_EQ(bench.stage.status.grind_count, 5U);
  EXPECT_EQ(std::count_if(
                bench.stage.handed_over.begin(), bench.stage.handed_over.end(),
                [](const auto& entry) { return entry.command.action == StageAction::grind_pass; }),
            5);
}

TEST(JobIssuing, HandsAGrindOverAgainOnlyAfterReadingBackThatItWasNotStarted) {
  JobBench bench;
  bench.stage.lost_answer = {StageAction::grind_pass, false};
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.stage.ground().size(), 5U);
  EXPECT_EQ(bench.count_rows("grinds"), 5);
  // The same number twice: a first message that was merely late would have changed nothing.
  const auto& calls = bench.stage.handed_over;
  const auto first = std::find_if(calls.begin(), calls.end(), [](const auto& entry) {
    return entry.command.action == StageAction::grind_pass;
  });
  ASSERT_NE(std::next(first), calls.end());
  EXPECT_EQ(first->sequence, std::next(first)->sequence);
}

TEST(JobRecovery, DecidesNothingBeforeTheControllerIsIdleAndTheWheelStands) {
  for (const bool busy : {true, false}) {
    JobBench bench;
    bench.start_job();
    ASSERT_TRUE(bench.reach(JobState::recovering));
    if (busy) {
      bench.stage.status.state = bridge::ControllerState::busy;
    } else {
      bench.stage.status.spindle_rpm = -300.0;  // it runs down, backwards
    }
    bench.tick(20);
    EXPECT_EQ(bench.state(), JobState::recovering);
    EXPECT_TRUE(bench.stage.executed.empty());
    bench.stage.status.state = bridge::ControllerState::idle;
    bench.stage.status.spindle_rpm = 0.0;
    EXPECT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
  }
}

TEST(JobRecovery, DoesNotSearchTheFocusAgain) {
  JobBench bench;
  die_in(bench, JobState::clearing, 3);
  restart(bench);
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("focus_sweeps"), 1);
}

}  // namespace
}  // namespace biotomy::tests
