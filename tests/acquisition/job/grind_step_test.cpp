// What must be so after a grind pass, seen from a job that grinds its first layer.
#include "acquisition/job/grind_step.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/job/job.hpp"
#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;

struct GrindStepTest : testing::Test {
  GrindStepTest() {
    bench.start_job();
    EXPECT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
  }
  void begin_the_pass() {
    for (int i = 0; i < 50 && bench.stage.ground().empty(); ++i) bench.tick();
    ASSERT_EQ(bench.stage.ground().size(), 1U);
  }
  void expect_stop(AlarmKind kind, const std::string& cause) {
    ASSERT_TRUE(bench.reach(JobState::faulted, 50));
    EXPECT_THAT(bench.alarm(), HasSubstr(cause));
    EXPECT_EQ(bench.board.look()->alarm->kind, kind);
    EXPECT_EQ(bench.stage.ground().size(), 1U);
  }
  JobBench bench;
};

TEST_F(GrindStepTest, StopsTheJobWhenThePassIsRefused) {
  bench.stage.interlocked = true;
  expect_stop(AlarmKind::controller,
              "the controller answered the grind pass of layer 1 with refused");
  EXPECT_EQ(bench.count_rows("grinds", "result = 'refused'"), 1);
}

TEST_F(GrindStepTest, StopsTheJobWhenMorePassesAreCountedThanWereAskedFor) {
  begin_the_pass();
  ++bench.stage.status.grind_count;
  expect_stop(AlarmKind::disagreement, "the controller counts 2");
}

TEST_F(GrindStepTest, StopsTheJobWhenThePassIsNotCounted) {
  begin_the_pass();
  --bench.stage.status.grind_count;
  expect_stop(AlarmKind::disagreement, "the controller counts 0");
}

TEST_F(GrindStepTest, StopsTheJobWhenTheBlockWasGroundDeeperThanTheFeedShows) {
  begin_the_pass();
  bench.stage.status.ground_to = {1030.0};
  expect_stop(AlarmKind::motion, "the ground position is at 1030.0 µm and should be at 1000.0 µm");
}

}  // namespace
}  // namespace biotomy::tests
