#include "acquisition/job/job.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Job, GrindsPhotographsAndStoresEveryLayerInOrder) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done)) << to_string(bench.state()) << ": " << bench.alarm();
  EXPECT_THAT(bench.stage.ground(), ElementsAre(1000.0, 1020.0, 1040.0, 1060.0, 1080.0));
  EXPECT_THAT(bench.written,
              ElementsAre("000001.tif", "000002.tif", "000003.tif", "000004.tif", "000005.tif"));
  EXPECT_EQ(bench.count_rows("layers"), 5);
  EXPECT_EQ(bench.count_rows("grinds", "result = 'done'"), 5);
  EXPECT_EQ(bench.count_rows("attempts", "verdict = 'accepted'"), 5);
  EXPECT_EQ(bench.in_volume, 5);
  EXPECT_TRUE(bench.volume_finished);
  EXPECT_TRUE(bench.lines.on.empty());  // the lamp is off
  EXPECT_EQ(bench.stage.status.traverse.value, 0.0);
  EXPECT_EQ(bench.board.look()->committed, 5);
}

TEST(Job, ShowsTheCommandsThatItWouldObey) {
  using enum OperatorCommand;
  JobBench bench;
  bench.start_daemon();
  bench.tick(3);
  EXPECT_THAT(bench.board.look()->commands, ElementsAre(start, acknowledge));
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  EXPECT_THAT(bench.board.look()->commands, ElementsAre(pause, abort));
  EXPECT_FALSE(bench.say(start).accepted);
  EXPECT_TRUE(bench.say(pause).accepted);
  ASSERT_TRUE(bench.reach(JobState::paused));
  EXPECT_THAT(bench.board.look()->commands, ElementsAre(resume, abort));
  EXPECT_TRUE(bench.say(abort).accepted);
  ASSERT_TRUE(bench.reach(JobState::aborted));
  EXPECT_THAT(bench.board.look()->commands,
              ElementsAre(start, calibrate_flat, calibrate_dark, calibrate_white, calibrate_focus));
}

TEST(Job, SaysWhatStandsInTheWayInsteadOfBeginning) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.say(OperatorCommand::pause).accepted);
  ASSERT_TRUE(bench.reach(JobState::paused));
  bench.lines.inputs.door_open = true;
  bench.tick();
  EXPECT_THAT(bench.board.look()->commands, ElementsAre(OperatorCommand::abort));
  const OperatorReply reply = bench.say(OperatorCommand::resume);
  EXPECT_FALSE(reply.accepted);
  EXPECT_THAT(reply.sentence, HasSubstr("the door is open"));
  EXPECT_EQ(bench.state(), JobState::paused);
  bench.lines.inputs.door_open = false;
  EXPECT_TRUE(bench.say(OperatorCommand::resume).accepted);
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
}

TEST(Job, FindsTheFocusOnceAndFollowsTheFaceAfterwards) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("focus_sweeps"), 1);
  // Sharp where column = face - 400: the last face is at 1080.
  EXPECT_NEAR(bench.stage.status.column.value, 680.0, 3.0);
}

TEST(Job, CarriesANewNumberWithEveryCommand) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done));
  for (std::size_t i = 1; i < bench.stage.executed.size(); ++i) {
    EXPECT_GT(bench.stage.executed[i].sequence, bench.stage.executed[i - 1].sequence);
  }
}

TEST(Job, GivesAnotherHeartbeatAtEveryExchange) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done));
  const auto& beats = bench.stage.heartbeats;
  EXPECT_EQ(std::adjacent_find(beats.begin(), beats.end()), beats.end());
}

TEST(Job, WritesAGrindDownBeforeItIsIssued) {
  JobBench bench;
  int checked = 0;
  bench.stage.on_command = [&](const bridge::StageCommand& command) {
    if (command.action != bridge::StageAction::grind_pass) return;
    EXPECT_EQ(bench.count_rows("grinds", "finished_at IS NULL AND target_um = " +
                                             std::to_string(command.position.value)),
              1);
    ++checked;
  };
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done));
  EXPECT_EQ(checked, 5);
}

TEST(Job, DoesNotGrindBeforeTheLayerBeforeIsStoredAndCommitted) {
  JobBench bench;
  bench.stage.on_command = [&](const bridge::StageCommand& command) {
    if (command.action != bridge::StageAction::grind_pass) return;
    const auto ground_before = static_cast<std::int64_t>(bench.stage.ground().size());
    EXPECT_EQ(bench.count_rows("layers"), ground_before);
    EXPECT_EQ(static_cast<std::int64_t>(bench.written.size()), ground_before);
  };
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done));
}

TEST(Job, GrindsNoFurtherWhenALayerCannotBeStored) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(2)) << bench.alarm();
  bench.store_failure = "layers/000003.tif: No space left on device";
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_THAT(bench.alarm(), HasSubstr("No space left on device"));
  bench.tick(500);
  EXPECT_EQ(bench.stage.ground().size(), 3U);
  EXPECT_EQ(bench.count_rows("layers"), 2);
  EXPECT_EQ(bench.count_rows("attempts", "layer = 3 AND verdict = 'not_stored'"), 1);
}

TEST(Job, PausesBetweenTwoStepsWithTheRigParkedAndGoesOn) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  EXPECT_TRUE(bench.say(OperatorCommand::pause).accepted);
  ASSERT_TRUE(bench.reach(JobState::paused));
  EXPECT_EQ(bench.stage.status.traverse.value, 0.0);
  EXPECT_EQ(bench.stage.ground().size(), 1U);
  EXPECT_FALSE(bench.say(OperatorCommand::start).accepted);
  EXPECT_TRUE(bench.say(OperatorCommand::resume).accepted);
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.stage.ground().size(), 5U);  // layer 1 was not ground again
}

TEST(Job, StoresAFrameInHandBeforeItPauses) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::assessing));
  EXPECT_TRUE(bench.say(OperatorCommand::pause).accepted);
  ASSERT_TRUE(bench.reach(JobState::paused));
  EXPECT_EQ(bench.count_rows("layers"), 1);
}

TEST(Job, AbortsAtOnceAndCanBeStartedAgainWhereItWas) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(2)) << bench.alarm();
  EXPECT_TRUE(bench.say(OperatorCommand::abort).accepted);
  ASSERT_TRUE(bench.reach(JobState::aborted));
  EXPECT_GE(bench.stage.count(bridge::StageAction::stop), 1);
  EXPECT_TRUE(bench.say(OperatorCommand::start).accepted);
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("layers"), 5);
}

TEST(Job, RefusesWhatTheStateForbidsInASentence) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  for (const OperatorCommand command :
       {OperatorCommand::start, OperatorCommand::resume, OperatorCommand::acknowledge}) {
    const OperatorReply reply = bench.say(command);
    EXPECT_FALSE(reply.accepted) << to_string(command);
    EXPECT_THAT(reply.sentence, HasSubstr("the job is "));
  }
}

TEST(Job, ComesToRestWhenTheDaemonIsToldToEnd) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::focusing));
  EXPECT_TRUE(bench.say(OperatorCommand::shut_down).accepted);
  ASSERT_TRUE(bench.reach(JobState::paused));
  EXPECT_TRUE(bench.job->at_rest());
  EXPECT_FALSE(bench.say(OperatorCommand::resume).accepted);
}

TEST(Job, ClosesTheRecordsOfTheRunBeforeByItsWorker) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  ASSERT_TRUE(bench.say(OperatorCommand::abort).accepted);
  ASSERT_TRUE(bench.reach(JobState::aborted)) << bench.alarm();
  // As long as a journal is open its log is there.
  const std::filesystem::path log = bench.settings.plan.sample / "journal.sqlite-wal";
  std::vector<bool> open;  // before a task and after it, in turns
  bench.worker.at_edges = [&] { open.push_back(std::filesystem::exists(log)); };
  ASSERT_TRUE(bench.say(OperatorCommand::start).accepted);
  bench.worker.at_edges = [] {};
  EXPECT_THAT(open, testing::Contains(false)) << "it was never closed";
  for (std::size_t i = 2; i < open.size(); i += 2) {
    EXPECT_EQ(open[i], open[i - 1]) << "the control thread has closed it, or opened it";
  }
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
}

TEST(Job, PreparesALayerWhileItIsAssessedAndGivesUpThatOfARejectedFrame) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  bench.camera.black_frames = 1;  // layer 2 needs no search: its first attempt
  ASSERT_TRUE(bench.reach(JobState::assessing));
  EXPECT_EQ(bench.prepared, 2);
  ASSERT_TRUE(bench.reach(JobState::capturing));
  EXPECT_TRUE(bench.last_prepared.expired());
  EXPECT_EQ(bench.released_by_control, 0) << "the control thread would have waited for the disk";
  EXPECT_EQ(bench.written.size(), 1U);
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.prepared, 6);
  EXPECT_EQ(bench.written.size(), 5U);
}

TEST(Job, ClimbsTheLadderUntilAFrameIsGood) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  bench.camera.black_frames = 2;  // layer 2 needs no search: its first two attempts
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "layer = 2 AND slug = 'too-dark'"), 2);
  EXPECT_EQ(bench.count_rows("attempts", "layer = 2 AND verdict = 'accepted' AND attempt = 3"), 1);
  EXPECT_EQ(bench.count_rows("focus_sweeps", "layer = 2"), 1);  // the second rung focuses again
  EXPECT_TRUE(
      std::filesystem::exists(bench.settings.plan.sample / "rejected/000002-a01-too-dark.jpg"));
}

TEST(Job, RecordsARejectedFrameWhosePictureCannotBeKept) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  const auto rejected = bench.settings.plan.sample / "rejected";
  std::filesystem::remove_all(rejected);
  std::ofstream(rejected) << "no folder";
  bench.camera.black_frames = 1;
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_EQ(bench.count_rows("attempts",
                             "layer = 2 AND slug = 'too-dark' AND file = '' AND "
                             "reason LIKE '%no picture of it is kept%'"),
            1);
}

TEST(Job, PausesWhenNoFrameIsGoodEnoughAndKeepsEveryRecord) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  bench.camera.black_frames = 1000000;
  ASSERT_TRUE(bench.reach(JobState::paused)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "layer = 2 AND verdict = 'rejected'"), 4);
  EXPECT_EQ(bench.count_rows("layers"), 1);
  EXPECT_THAT(bench.events_of_kind("alarm"), HasSubstr("no frame of layer 2 was good enough"));

  bench.camera.black_frames = 0;
  EXPECT_TRUE(bench.say(OperatorCommand::resume).accepted);
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.stage.ground().size(), 5U);
  EXPECT_EQ(bench.count_rows("attempts", "layer = 2 AND verdict = 'accepted' AND attempt = 5"), 1);
}

TEST(Job, PausesAfterASecondFrameWhenTheGrindRemovedNothing) {
  for (const auto exhausted :
       {LadderSettings::Exhausted::pause, LadderSettings::Exhausted::accept}) {
    JobBench bench;
    bench.settings.ladder.exhausted = exhausted;
    bench.start_daemon();
    bench.start_job();
    ASSERT_TRUE(bench.reach_committed(2)) << bench.alarm();
    bench.camera.stuck_face_um = 1020.0;  // layer 2's
    ASSERT_TRUE(bench.reach(JobState::paused)) << bench.alarm();
    EXPECT_EQ(bench.count_rows("attempts", "layer = 3 AND slug = 'face-unchanged'"), 2);
    EXPECT_EQ(bench.count_rows("attempts", "layer = 3"), 2);
    EXPECT_EQ(bench.count_rows("layers"), 2);
    EXPECT_EQ(bench.stage.ground().size(), 3U);
    EXPECT_THAT(bench.events_of_kind("alarm"), HasSubstr("differs from layer 2's"));
    EXPECT_THAT(bench.events_of_kind("alarm"), HasSubstr("look at the wheel"));

    bench.camera.stuck_face_um.reset();
    EXPECT_TRUE(bench.say(OperatorCommand::resume).accepted);
    ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
    EXPECT_EQ(bench.count_rows("layers"), 5);
  }
}

TEST(Job, ComparesTheFirstFaceAfterARestartWithTheLastStoredOne) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(2)) << bench.alarm();
  bench.start_daemon();
  bench.camera.stuck_face_um = 1020.0;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::paused)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "layer = 3 AND slug = 'face-unchanged'"), 2);
}

TEST(Job, DoesNotAcceptABlurredFrameOfAFaceThatTurnsOutToBeOld) {
  JobBench bench;
  bench.settings.ladder.exhausted = LadderSettings::Exhausted::accept;
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(2)) << bench.alarm();
  bench.camera.stuck_face_um = 1020.0;     // layer 2's
  bench.camera.column_to_face_um += 60.0;  // and out of focus, until the ladder focuses again
  ASSERT_TRUE(bench.reach(JobState::paused)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "layer = 3 AND slug = 'blurred'"), 2);
  EXPECT_EQ(bench.count_rows("attempts", "layer = 3 AND slug = 'face-unchanged'"), 2);
  EXPECT_EQ(bench.count_rows("layers"), 2);
}

TEST(Job, NeverStoresAnOldPictureWhateverThePolicy) {
  JobBench bench;
  bench.settings.ladder.exhausted = LadderSettings::Exhausted::accept;
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(2)) << bench.alarm();
  bench.camera.frozen = true;
  ASSERT_TRUE(bench.reach(JobState::paused)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("layers"), 2);
  EXPECT_EQ(bench.count_rows("attempts", "layer = 3 AND slug = 'stale'"), 4);
  EXPECT_THAT(bench.events_of_kind("alarm"), HasSubstr("the camera gave an old picture again"));
}

TEST(Job, TakesAgainAFrameThatWasExposedBeforeItWasAskedFor) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  bench.camera.old_frames = 1;
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "layer = 2 AND slug = 'stale'"), 1);
}

TEST(Job, TakesAgainAFrameWhoseNumberItHasSeenAlready) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  bench.camera.repeated_frames = 1;
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "layer = 2 AND slug = 'stale'"), 1);
}

/// A job that accepts, and to which no frame is sharp enough.
struct UnsharpBench : JobBench {
  UnsharpBench() {
    settings.ladder.exhausted = LadderSettings::Exhausted::accept;
    settings.thresholds.minimum_sharpness_ratio = 2.0;
    start_daemon();
  }
};

TEST(Job, AcceptsTheSharpestWithAFlagWhenConfiguredSo) {
  UnsharpBench bench;
  bench.settings.plan.layers = 1;
  bench.settings.ladder.max_attempts = 2;
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts"), 2);
  EXPECT_EQ(bench.count_rows("attempts", "verdict = 'rejected'"), 1);
  EXPECT_EQ(bench.count_rows("attempts", "verdict = 'accepted_with_flag'"), 1);
}

TEST(Job, AcceptsNothingWithAFlagThatLacksMoreThanSharpness) {
  JobBench bench;
  bench.settings.ladder.exhausted = LadderSettings::Exhausted::accept;
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  bench.camera.black_frames = 1000000;
  ASSERT_TRUE(bench.reach(JobState::paused)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "layer = 2 AND slug = 'too-dark'"), 4);
  EXPECT_EQ(bench.count_rows("layers"), 1);
  EXPECT_EQ(bench.stage.ground().size(), 2U);
  EXPECT_THAT(bench.events_of_kind("alarm"), HasSubstr("the lamp is dark"));
  EXPECT_THAT(
      bench.events_of_kind("alarm"),
      HasSubstr("quality.policy accepts a frame that is not quite sharp, and nothing worse"));
}

TEST(Job, AcceptsNoEarlierFrameOfALayerWhoseLastOneLacksMoreThanSharpness) {
  UnsharpBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  const auto second_attempt = [&] {
    const auto status = bench.board.look();
    return status->layer == 2 && status->attempt == 2 && status->state == JobState::assessing;
  };
  for (int i = 0; i < 5000 && !second_attempt(); ++i) bench.tick();
  bench.camera.black_frames = 1000000;
  ASSERT_TRUE(bench.reach(JobState::paused)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "layer = 2 AND slug = 'blurred'"), 2);
  EXPECT_EQ(bench.count_rows("attempts", "layer = 2 AND slug = 'too-dark'"), 2);
  EXPECT_EQ(bench.count_rows("layers"), 1);
}

TEST(Job, PausesWhenTheLayersBeforeHaveAFlagAlsoAfterARestart) {
  UnsharpBench bench;
  bench.settings.ladder.flagged_in_a_row = 2;
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::paused)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "verdict = 'accepted_with_flag'"), 2);
  EXPECT_EQ(bench.count_rows("attempts", "layer = 3 AND verdict = 'rejected'"), 4);
  EXPECT_THAT(bench.events_of_kind("alarm"),
              HasSubstr("quality.flagged_in_a_row allows 2 layers in a row with a flag, and the "
                        "last 2 have one: look at it, then resume"));

  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::paused)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "layer = 3 AND verdict = 'rejected'"), 8);

  bench.settings.thresholds = {};
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("layers"), 5);
}

TEST(Job, MeasuresNoLayerByOneThatHasAFlag) {
  JobBench bench;
  bench.settings.plan.layers = 9;
  bench.settings.ladder.exhausted = LadderSettings::Exhausted::accept;
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(3)) << bench.alarm();
  bench.camera.veil = 0.2;
  ASSERT_TRUE(bench.reach(JobState::paused)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("layers"), 6);
  EXPECT_EQ(bench.count_rows("attempts", "verdict = 'accepted_with_flag'"), 3);
}

}  // namespace
}  // namespace biotomy::tests
