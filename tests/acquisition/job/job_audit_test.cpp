// What the journal tells of operators, and what the status tells of pauses and attempts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::AllOf;
using testing::HasSubstr;

struct JobAudit : testing::Test, JobBench {
  void command(OperatorCommand what, const std::string& reason, const std::string& who) {
    auto reply = desk.post(what, reason, who);
    for (int i = 0; i < 1000 && !is_ready(reply); ++i) tick();
    ASSERT_TRUE(is_ready(reply));
  }
};

TEST_F(JobAudit, HasWhoDidWhatWhyAndWhatWasAnswered) {
  start_job();
  ASSERT_TRUE(reach(JobState::grinding));
  command(OperatorCommand::pause, "lunch", "anna from 10.0.0.7");
  command(OperatorCommand::start, "", "bert from 10.0.0.8");
  const std::string events = events_of_kind("operator");
  EXPECT_THAT(events, HasSubstr("pause by anna from 10.0.0.7 (lunch): the step at hand"));
  EXPECT_THAT(events, HasSubstr("start by bert from 10.0.0.8 was refused: the job is "));
}

TEST_F(JobAudit, LosesNothingThatCameBeforeAJournalWasOpen) {
  tick();
  command(OperatorCommand::resume, "too early", "anna from 10.0.0.7");
  desk.remark("refused 10.0.0.9: start, a wrong token");
  tick();
  EXPECT_FALSE(std::filesystem::exists(settings.plan.sample / "journal.sqlite"));
  command(OperatorCommand::start, "good evening", "anna from 10.0.0.7");
  ASSERT_TRUE(reach(JobState::grinding));
  EXPECT_THAT(events_of_kind("operator"),
              AllOf(HasSubstr("resume by anna from 10.0.0.7 (too early) was refused"),
                    HasSubstr("refused 10.0.0.9: start, a wrong token"),
                    HasSubstr("start by anna from 10.0.0.7 (good evening): ")));
}

TEST_F(JobAudit, HasRemarksOfARunningJob) {
  start_job();
  ASSERT_TRUE(reach(JobState::grinding));
  desk.remark("refused 10.0.0.9: abort, no token");
  tick();
  EXPECT_THAT(events_of_kind("operator"), HasSubstr("refused 10.0.0.9: abort, no token"));
}

TEST_F(JobAudit, HasFramesThatDidNotArriveThoughTheNextOneDid) {
  start_job();
  ASSERT_TRUE(reach_committed(1)) << alarm();
  camera.late_frames = 1;
  ASSERT_TRUE(reach_committed(2)) << alarm();
  EXPECT_EQ(events_of_kind("recovery").find("no frame: camera: no packet in time"),
            events_of_kind("recovery").rfind("no frame: "));
  EXPECT_THAT(events_of_kind("recovery"), HasSubstr("no frame: camera: no packet in time\n"));
}

TEST_F(JobAudit, HasWhatTheCameraWentThroughToGiveAFrame) {
  start_job();
  ASSERT_TRUE(reach_committed(1)) << alarm();
  camera.remark = "camera: it was started anew";
  ASSERT_TRUE(reach_committed(2)) << alarm();
  EXPECT_THAT(events_of_kind("recovery"), HasSubstr("camera: it was started anew\n"));
}

TEST_F(JobAudit, ShowsWhyTheJobPausedByItself) {
  start_job();
  ASSERT_TRUE(reach_committed(1)) << alarm();
  camera.black_frames = 1000000;
  ASSERT_TRUE(reach(JobState::paused)) << alarm();
  EXPECT_THAT(board.look()->pause_cause, HasSubstr("no frame of layer 2 was good enough"));
  ASSERT_TRUE(board.look()->last_attempt);
  EXPECT_EQ(board.look()->last_attempt->verdict, Verdict::rejected);
  say(OperatorCommand::resume);
  EXPECT_EQ(board.look()->pause_cause, "");
}

TEST_F(JobAudit, ShowsNoCauseOfAPauseThatAnOperatorAskedFor) {
  start_job();
  ASSERT_TRUE(reach(JobState::grinding));
  say(OperatorCommand::pause);
  ASSERT_TRUE(reach(JobState::paused));
  EXPECT_EQ(board.look()->pause_cause, "");
}

}  // namespace
}  // namespace biotomy::tests
