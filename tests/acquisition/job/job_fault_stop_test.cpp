// How a fault brings the rig to rest, and when its latch opens again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/job/job.hpp"
#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using bridge::StageAction;
using testing::HasSubstr;

constexpr std::uint16_t kWatchdog = 3;

// Else the stop would be taken for one that was carried out already.
TEST(JobFaultStop, NumbersTheStopAboveWhatSomebodyElseCommanded) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.tick(2);
  bench.stage.status.sequence_started = 5000;
  bench.tick();
  bench.lines.inputs.estop_pressed = true;
  bench.tick();
  EXPECT_GT(bench.stage.handed_over.back().sequence, 5000U);
  EXPECT_EQ(bench.stage.executed.back().command.action, StageAction::stop);
}

TEST(JobFaultStop, StopsTheRigWhenTheProgramEndsBeforeItIsAtRest) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.tick(2);
  bench.job->halt(bench.now);
  EXPECT_EQ(bench.stage.executed.back().command.action, StageAction::stop);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.events_of_kind("alarm"), HasSubstr("before the rig was at rest"));
}

TEST(JobFaultStop, CommandsNothingWhenTheProgramEndsAtRest) {
  JobBench bench;
  bench.tick(10);
  bench.job->halt(bench.now);
  EXPECT_TRUE(bench.stage.handed_over.empty());
}

TEST(JobFaultStop, TakesNoAcknowledgementWhileTheRigIsParked) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::clearing));
  bench.camera.gone = true;
  ASSERT_TRUE(bench.reach(JobState::faulted));
  bench.stage.exchanges_per_command = 50;
  bench.tick(6);
  EXPECT_FALSE(bench.job->at_rest());
  EXPECT_THAT(bench.say(OperatorCommand::acknowledge).sentence, HasSubstr("still being parked"));
  bench.tick(100);
  EXPECT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
}

// It acts by itself then, and somebody may be near.
TEST(JobFaultStop, LeavesTheParkingToAControllerThatSeesItsOwnEstopOrDoor) {
  for (const bool door : {false, true}) {
    JobBench bench;
    bench.start_job();
    ASSERT_TRUE(bench.reach(JobState::clearing));
    const int retracted = bench.stage.count(StageAction::retract);
    bench.camera.gone = true;
    ASSERT_TRUE(bench.reach(JobState::faulted));
    ASSERT_EQ(bench.stage.count(StageAction::retract), retracted);
    bench.stage.status.interlocks.estop_pressed = !door;
    bench.stage.status.interlocks.door_open = door;
    bench.tick(100);
    EXPECT_EQ(bench.stage.count(StageAction::retract), retracted);
    EXPECT_TRUE(bench.job->at_rest());
  }
}

TEST(JobFaultStop, ClosesTheLatchAgainWhenACauseComesWhileItIsReset) {
  JobBench bench;
  bench.stage.fault(kWatchdog);
  bench.stage.exchanges_per_command = 50;
  bench.tick();
  auto reply = bench.desk.post(OperatorCommand::acknowledge, "");
  bench.tick(10);
  ASSERT_EQ(bench.state(), JobState::resetting);
  bench.lines.inputs.door_open = true;
  bench.tick();
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr("the door is open (line)"));
  ASSERT_TRUE(is_ready(reply));
  EXPECT_FALSE(reply.get().accepted);
}

}  // namespace
}  // namespace biotomy::tests
