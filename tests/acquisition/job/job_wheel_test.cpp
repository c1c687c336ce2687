// Where the wheel must stand, and what a job does when it turns there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/job/job.hpp"
#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;

TEST(JobsWheel, StopsWhenTheWheelTurnsOnAfterItIsRetracted) {
  JobBench bench;
  bench.settings.limits.retract_limit = bench.settings.limits.park_limit =
      std::chrono::milliseconds(2000);
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::retracting));
  bench.stage.wheel_runs_on = true;
  const int captures = bench.camera.captures;
  ASSERT_TRUE(bench.reach(JobState::faulted, 300));
  EXPECT_THAT(bench.alarm(), HasSubstr("waits for the wheel to stand"));
  EXPECT_THAT(bench.alarm(), HasSubstr("turns at 1500 rpm"));
  EXPECT_EQ(bench.camera.captures, captures);
}

TEST(JobsWheel, WaitsForAWheelThatRunsDown) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::retracting));
  bench.stage.wheel_runs_on = true;
  for (int i = 0; i < 20; ++i) bench.tick();
  EXPECT_EQ(bench.state(), JobState::retracting);
  bench.stage.status.spindle_rpm = 0.0;
  bench.stage.wheel_runs_on = false;
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
}

TEST(JobsWheel, StopsWhenTheWheelStartsByItself) {
  JobBench bench;
  bench.settings.plan.settle_duration = std::chrono::milliseconds(2000);
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::assessing));
  bench.stage.status.spindle_rpm = 14.0;  // an encoder's noise, if a strong one
  bench.tick(30);
  EXPECT_NE(bench.state(), JobState::faulted);
  ASSERT_TRUE(bench.reach(JobState::clearing)) << bench.alarm();
  bench.stage.status.spindle_rpm = 50.0;
  bench.stage.wheel_runs_on = true;
  ASSERT_TRUE(bench.reach(JobState::faulted)) << "also while commands are under way";
  EXPECT_THAT(bench.alarm(), HasSubstr("the wheel turns at 50.0 rpm where it must stand"));
}

TEST(JobsWheel, StopsWhenTheWheelStartsBeforeAnythingIsAskedOfIt) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::recovering));
  bench.stage.status.spindle_rpm = 50.0;
  bench.stage.wheel_runs_on = true;
  bench.tick(50);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr("the wheel turns at 50.0 rpm where it must stand"));
}

TEST(JobsWheel, IsNotBegunWhileTheWheelTurns) {
  JobBench bench;
  ASSERT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
  ASSERT_TRUE(bench.reach(JobState::idle));
  bench.stage.status.spindle_rpm = 50.0;
  bench.stage.wheel_runs_on = true;
  EXPECT_THAT(bench.say(OperatorCommand::start).sentence, HasSubstr("the wheel still turns"));
  bench.stage.status.spindle_rpm = 0.0;
  EXPECT_TRUE(bench.say(OperatorCommand::start).accepted);
}

}  // namespace
}  // namespace biotomy::tests
