// What a job does while the worker, which has the disk and the camera, takes its time.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/job/earlier_run.hpp"
#include "acquisition/job/job.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tests/acquisition/held_job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct JobThatWaits : testing::Test {
  JobThatWaits() { bench.start_job(); }
  HeldJobBench bench;
};

TEST_F(JobThatWaits, DoesNotIssueAGrindBeforeItsIntentIsWritten) {
  ASSERT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
  bench.tick(200);
  EXPECT_EQ(bench.state(), JobState::grinding);
  EXPECT_THAT(bench.stage.ground(), IsEmpty());
  bench.held.run();
  bench.tick(2);
  EXPECT_THAT(bench.stage.ground(), ElementsAre(1000.0));
}

// A control thread that waited for the worker would never end here.
TEST_F(JobThatWaits, TicksOnWhileAFrameIsTakenAssessedAndStored) {
  for (const JobState state : {JobState::capturing, JobState::assessing, JobState::storing}) {
    ASSERT_TRUE(bench.reach(state)) << bench.alarm();
    bench.tick(3);
    EXPECT_EQ(bench.state(), state);
  }
  EXPECT_EQ(bench.count_rows("layers"), 0);
  bench.held.run();
  bench.tick();
  EXPECT_EQ(bench.count_rows("layers"), 1);
  EXPECT_EQ(bench.board.look()->committed, 1);
}

TEST_F(JobThatWaits, LeavesOneRecordOfAFrameThatAnAlarmOvertakesWhileItIsStored) {
  ASSERT_TRUE(bench.reach(JobState::storing)) << bench.alarm();
  bench.lines.inputs.door_open = true;
  bench.tick();
  EXPECT_EQ(bench.state(), JobState::faulted);
  bench.held.run();
  EXPECT_EQ(bench.count_rows("attempts"), 1);
  EXPECT_EQ(bench.count_rows("attempts", "verdict = 'accepted'"), 1);
  EXPECT_EQ(bench.count_rows("layers"), 1);
  const std::filesystem::path rejected = bench.settings.plan.sample / "rejected";
  EXPECT_TRUE(!std::filesystem::exists(rejected) || std::filesystem::is_empty(rejected))
      << "no picture of it is kept as of one that was given up";
}

// The power may go before a camera that hangs has answered.
TEST_F(JobThatWaits, HasItsAlarmInTheJournalBeforeTheWorkerIsDone) {
  ASSERT_TRUE(bench.reach(JobState::storing)) << bench.alarm();
  bench.lines.inputs.estop_pressed = true;
  bench.tick();
  ASSERT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.events_of_kind("alarm"), HasSubstr("the e-stop is pressed"));
  const EarlierRun found =
      read_earlier_run(bench.settings.plan.sample / reconstruct::SampleFolder::kJournalName);
  EXPECT_FALSE(found.was_running);
  EXPECT_THAT(found.alarm, HasSubstr("the e-stop is pressed"));
}

}  // namespace
}  // namespace biotomy::tests
