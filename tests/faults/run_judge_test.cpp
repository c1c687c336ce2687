#include "tests/faults/run_judge.hpp"

#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tests/faults/made_up_run.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using reconstruct::SampleFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kLayers = MadeUpRun::kLayers;

class RunJudge : public testing::Test {
 protected:
  RunJudge() {
    for (std::int64_t layer = 1; layer <= kLayers; ++layer) {
      reconstruct::write_layer_image(undisturbed_.layer_path(layer),
                                     MadeUpRun::photograph(layer, 1000 + static_cast<int>(layer)),
                                     {layer, {10.0, 10.0, MadeUpRun::kThicknessUm}}, {});
    }
  }

  std::vector<std::string> verdict() const { return judge(run.finished(), undisturbed_.path()); }

  TemporaryFolder folder_;
  MadeUpRun run{folder_.path()};

 private:
  SampleFolder undisturbed_ = MadeUpRun::new_sample(folder_ / "undisturbed");
};

TEST_F(RunJudge, FindsNothingWrongWithAGoodRun) {
  run.make_from(1);
  EXPECT_THAT(verdict(), IsEmpty());
}

TEST_F(RunJudge, FindsTwoLayersThatWereSwapped) {
  run.make(1);
  for (const std::int64_t layer : {2, 3}) {
    run.grind(layer);
    run.take_frame(layer);
    run.commit(layer, 5 - layer);
  }
  run.make(4);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("the image of layer 2 differs by"),
                                     HasSubstr("the image of layer 3 differs by")));
}

TEST_F(RunJudge, FindsALayerThatIsNotCommitted) {
  run.make(1);
  run.make(2);
  run.make(3);
  run.grind(4);
  EXPECT_THAT(verdict(), ElementsAre("layer 4 is not committed"));
}

TEST_F(RunJudge, FindsALayerThatWasNotGround) {
  run.make(1);
  run.make(2);
  run.make(3);
  run.take_frame(4);
  run.commit(4);
  EXPECT_THAT(verdict(), ElementsAre("layers 4 to 4 were not ground"));
}

TEST_F(RunJudge, FindsALayerThatWasSkipped) {
  run.make(1);
  run.make(3);
  run.make(4);
  EXPECT_THAT(verdict(), ElementsAre("command 2 ground layer 3 and layer 2 had not been ground",
                                     "layer 3 was ground and layer 2 was never committed",
                                     "layer 2 is not committed"));
}

TEST_F(RunJudge, FindsALayerThatWasGroundTwice) {
  run.make(1);
  run.grind(2);
  run.make(2);
  run.make_from(3);
  EXPECT_THAT(verdict(), ElementsAre("layer 2 was ground again by command 3"));
}

TEST_F(RunJudge, FindsAPassToWhereNoLayerIs) {
  run.make_from(1);
  run.grind(kLayers + 1);
  EXPECT_THAT(verdict(), ElementsAre("command 5 ground to 1080 µm, where no layer's face is"));
}

TEST_F(RunJudge, FindsALayerThatWasCommittedAfterTheNextGrind) {
  run.make(1);
  run.grind(2);
  run.take_frame(2);
  run.intend(3);
  run.begin_pass(3);
  run.commit(2);
  run.end_pass("done");
  run.take_frame(3);
  run.commit(3);
  run.make(4);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("layer 3 was ground at ")));
}

TEST_F(RunJudge, FindsAGrindThatAJournalAtAKillDidNotAllow) {
  run.make(1);
  run.make(2);
  run.kill(0);
  run.make_from(3);
  EXPECT_THAT(verdict(),
              ElementsAre(HasSubstr("layer 2 was ground and the journal held 0 committed layers")));
}

TEST_F(RunJudge, FindsAGrindWithoutAnIntent) {
  run.intend(2);
  run.begin_pass(1);
  run.end_pass("done");
  run.take_frame(1);
  run.commit(1);
  run.make_from(2);
  EXPECT_THAT(verdict(),
              ElementsAre("command 1 ground to 1000 µm and the journal does not know of it"));
}

TEST_F(RunJudge, FindsAnIntentThatWasWrittenAfterwards) {
  run.intend(1);
  run.begin_pass(1);
  run.end_pass("done");
  run.take_frame(1);
  run.commit(1);
  run.witness("command_started",
              {{"sequence", 2}, {"action", "grind_pass"}, {"position_um", MadeUpRun::face_um(2)}});
  run.intend(2);
  run.end_pass("done");
  run.take_frame(2);
  run.commit(2);
  run.make_from(3);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("command 2 began at ")));
}

TEST_F(RunJudge, FindsAFileThatWasDamaged) {
  run.make_from(1);
  std::fstream file(run.sample().layer_path(3), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(1000);
  file.put('\x55').put('\xaa');
  file.close();
  EXPECT_THAT(verdict(), ElementsAre("the file of layer 3 is not what was committed"));
}

TEST_F(RunJudge, FindsAFileThatIsMissing) {
  run.make_from(1);
  std::filesystem::remove(run.sample().layer_path(2));
  EXPECT_THAT(verdict(), ElementsAre("the file of layer 2 is missing"));
}

TEST_F(RunJudge, FindsAPhotographThatWasTakenInTheDark) {
  run.make(1);
  run.make(2);
  run.make(3);
  run.photograph_in_the_dark();
  run.make(4);
  EXPECT_THAT(verdict(),
              ElementsAre("the image of layer 4 was taken of the face at 1060.4 µm, in the dark"));
}

TEST_F(RunJudge, FindsAPhotographOfAnotherFace) {
  run.make(1);
  run.take_frame(1);
  run.grind(2);
  run.commit(2);
  run.make_from(3);
  EXPECT_THAT(verdict(), ElementsAre("the image of layer 2 was taken of the face at 1000.4 µm"));
}

TEST_F(RunJudge, TakesARejectedPictureUnderAnyNumberForASpoiltFrame) {
  run.make(1);
  run.grind(2);
  run.take_frame(2, 650.0, true);
  run.reject(2, 77);
  run.take_frame(2);
  run.commit(2);
  run.make_from(3);
  EXPECT_THAT(verdict(), IsEmpty());
}

TEST_F(RunJudge, FindsARejectedPictureThatTheTwinDidNotSpoil) {
  run.make(1);
  run.grind(2);
  run.reject(2, 77);
  run.take_frame(2);
  run.commit(2);
  run.make_from(3);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("shows frame 77, which the twin did not take")));
}

TEST_F(RunJudge, FindsAFrameWithoutARecord) {
  run.make(1);
  run.grind(2);
  run.take_frame(2);
  run.take_frame(2);
  run.commit(2);
  run.make_from(3);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("of layer 2, has no record")));
}

TEST_F(RunJudge, TakesFramesOfASearchForWhatTheyAre) {
  run.grind(1);
  run.take_frame(1, 640.0);
  run.move_column();
  run.take_frame(1, 660.0);
  run.record_search(1, {640.0, 660.0});
  run.move_column();
  run.take_frame(1);
  run.commit(1);
  run.make_from(2);
  EXPECT_THAT(verdict(), IsEmpty());
}

TEST_F(RunJudge, TakesATrialFrameForWhatItIs) {
  run.take_frame(1);
  run.note("recovery", "trial frame 1");
  run.make_from(1);
  EXPECT_THAT(verdict(), IsEmpty());
}

TEST_F(RunJudge, AllowsAKillOneFrameAndTheSearchThatItBrokeOff) {
  run.grind(1);
  for (const double column_um : {640.0, 650.0, 660.0}) {
    run.move_column();
    run.take_frame(1, column_um);
  }
  run.kill(0);
  run.take_frame(1);
  run.kill(0);
  run.take_frame(1);
  run.commit(1);
  run.make_from(2);
  EXPECT_THAT(verdict(), IsEmpty());
}

TEST_F(RunJudge, TellsASearchThatAKillBrokeOffFromTheOneThatRepeatedIt) {
  run.grind(1);
  for (const bool killed : {true, false}) {
    run.take_frame(1, 640.0);
    run.move_column();
    run.take_frame(1, 660.0);
    if (killed) run.kill(0);
  }
  run.record_search(1, {640.0, 660.0});
  run.move_column();
  run.take_frame(1);
  run.commit(1);
  run.make_from(2);
  EXPECT_THAT(verdict(), IsEmpty());
}

TEST_F(RunJudge, TellsTheLastFrameOfASearchFromTheOneAtItsPlaceThatAKillLost) {
  run.grind(1);
  run.take_frame(1, 640.0);
  run.move_column();
  run.take_frame(1, 660.0);
  run.take_frame(1, 660.0);
  run.record_search(1, {640.0, 660.0});  // of the same millisecond
  run.kill(0);
  run.take_frame(1);
  run.commit(1);
  run.make_from(2);
  EXPECT_THAT(verdict(), IsEmpty());
}

TEST_F(RunJudge, FindsFramesOfASearchThatAnAlarmBrokeOff) {
  run.grind(1);
  for (const double column_um : {640.0, 650.0, 660.0}) {
    run.move_column();
    run.take_frame(1, column_um);
  }
  run.alarm("focusing");
  run.take_frame(1);
  run.commit(1);
  run.make_from(2);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("frame 1 of "), HasSubstr("frame 2 of "),
                                     HasSubstr("frame 3 of ")));
}

TEST_F(RunJudge, FindsASearchThatMeasuredWhatWasNotTaken) {
  run.grind(1);
  run.take_frame(1, 640.0);
  run.record_search(1, {640.0, 660.0});
  run.move_column();
  run.take_frame(1);
  run.commit(1);
  run.make_from(2);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("measured a frame at 660 µm")));
}

TEST_F(RunJudge, DoesNotAllowAKillTwoFrames) {
  run.grind(1);
  run.take_frame(1);
  run.take_frame(1);
  run.kill(0);
  run.take_frame(1);
  run.commit(1);
  run.make_from(2);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("frame 1 of ")));
}

TEST_F(RunJudge, AllowsAnAlarmNoFrame) {
  run.grind(1);
  run.take_frame(1);
  run.alarm("focusing");
  run.take_frame(1);
  run.alarm("capturing");
  run.take_frame(1);
  run.commit(1);
  run.make_from(2);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("frame 1 of "), HasSubstr("frame 2 of ")));
}

TEST_F(RunJudge, AllowsTheCameraAFrameThatItTookWhenNobodyWaitedAnyMore) {
  run.make(1);
  run.grind(2);
  run.note("recovery", "no frame: camera: no packet in time");
  run.take_frame(2);
  run.take_frame(2);
  run.take_frame(2);
  run.commit(2);
  run.make_from(3);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("frame 3 of ")));
}

TEST_F(RunJudge, AllowsTheCameraTheFrameThatItWasToldNotToHaveGiven) {
  run.grind(1);
  run.take_frame(1);
  run.take_frame(1);
  run.note("recovery", "no frame: camera: no packet in time");
  run.take_frame(1);
  run.commit(1);
  run.make_from(2);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("frame 1 of ")));
}

TEST_F(RunJudge, AllowsAPassThatAKillBrokeOffIfAWholeOneFollows) {
  run.make(1);
  run.intend(2);
  run.begin_pass(2);
  run.kill(1);
  run.end_pass("aborted");
  run.make_from(2);
  EXPECT_THAT(verdict(), IsEmpty());
}

TEST_F(RunJudge, FindsAPassThatNothingBrokeOff) {
  run.make(1);
  run.intend(2);
  run.begin_pass(2);
  run.end_pass("aborted");
  run.make_from(2);
  EXPECT_THAT(verdict(), ElementsAre("the pass of command 2 over layer 2 ended as 'aborted' and "
                                     "nothing broke it off"));
}

TEST_F(RunJudge, BelievesARestartedTwinHowThePassEndedThatItsPredecessorWasAt) {
  run.make(1);
  run.intend(2);
  run.begin_pass(2);
  run.kill(1);
  run.start_twin("done");
  run.take_frame(2);
  run.commit(2);
  run.make_from(3);
  EXPECT_THAT(verdict(), IsEmpty());
}

TEST_F(RunJudge, CountsAPassThatWasWholeWhenTheTwinWasKilled) {
  run.make(1);
  run.intend(2);
  run.begin_pass(2);
  run.kill(1);
  run.start_twin("done");
  run.make_from(2);
  EXPECT_THAT(verdict(), ElementsAre("layer 2 was ground again by command 3"));
}

}  // namespace
}  // namespace biotomy::tests
