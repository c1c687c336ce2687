#include "tests/faults/run_judge.hpp"

#include <chrono>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/records/layer_journal.hpp"
#include "acquisition/records/utc_time.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using nlohmann::json;
using reconstruct::SampleFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kLayers = 4;
constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr double kFirstFaceUm = 1000.0;
constexpr double kThicknessUm = 20.0;

double face_um(std::int64_t layer) {
  return kFirstFaceUm + static_cast<double>(layer - 1) * kThicknessUm;
}

/// What a layer shows: coarse shapes of its own, and the noise of one photograph.
cv::Mat photograph(std::int64_t layer, int noise) {
  cv::RNG random(static_cast<std::uint64_t>(layer));
  cv::Mat coarse(kHeight / 8, kWidth / 8, CV_8UC3);
  random.fill(coarse, cv::RNG::UNIFORM, 90, 140);
  cv::Mat image;
  cv::resize(coarse, image, {kWidth, kHeight}, 0, 0, cv::INTER_CUBIC);
  cv::RNG grain(static_cast<std::uint64_t>(noise));
  cv::Mat speckle(image.size(), CV_16SC3);
  grain.fill(speckle, cv::RNG::NORMAL, 0, 1.6);
  cv::add(image, speckle, image, cv::noArray(), CV_8UC3);
  return image;
}

SampleFolder new_sample(const std::filesystem::path& folder) {
  reconstruct::SampleDescription description;
  description.name = "made up";
  description.cuboid = {.size = {kWidth, kHeight, kLayers}, .spacing = {10.0, 10.0, kThicknessUm}};
  return SampleFolder::create(folder, description);
}

/// A run as daemon and twin would leave it, written down event by event, a second each.
class MadeUpRun {
 public:
  explicit MadeUpRun(const std::filesystem::path& folder)
      : folder_(folder), sample_(new_sample(folder / "sample")), journal_(sample_.journal_path()) {
    start_twin("none");
  }

  std::string now() {
    return utc_text(std::chrono::system_clock::time_point(std::chrono::seconds(++second_)));
  }

  void witness(const char* event, json facts) {
    facts["time"] = now();
    facts["event"] = event;
    std::ofstream(folder_ / "witness.jsonl", std::ios::app) << facts.dump() << '\n';
  }

  void start_twin(const char* result) {
    frame_ = 0;
    witness("twin_started", {{"sequence", sequence_}, {"result", result}});
  }

  void intend(std::int64_t layer) {
    journal_.begin_grind({.sequence = ++sequence_, .layer = layer, .target = {face_um(layer)}},
                         now());
  }

  void begin_pass(std::int64_t layer) {
    witness("command_started",
            {{"sequence", sequence_}, {"action", "grind_pass"}, {"position_um", face_um(layer)}});
  }

  void end_pass(const char* result) {
    witness("command_finished",
            {{"sequence", sequence_}, {"action", "grind_pass"}, {"result", result}});
  }

  void grind(std::int64_t layer) {
    intend(layer);
    begin_pass(layer);
    end_pass("done");
  }

  void move_column() { witness("command_started", {{"sequence", 0}, {"action", "move_column"}}); }

  void take_frame(std::int64_t layer, double column_um = 650.0, bool spoilt = false) {
    witness("capture", {{"number", ++frame_},
                        {"face_um", face_um(layer) + 0.4},
                        {"column_um", column_um},
                        {"face_in_view", true},
                        {"lamp_on", lamp_on_},
                        {"spoilt", spoilt}});
  }

  /// Of a picture that came under a number which is not that of the last capture.
  void reject(std::int64_t layer, std::uint64_t frame) {
    AttemptRow row;
    row.layer = layer;
    row.attempt = ++attempt_;
    row.taken_at = now();
    row.frame_sequence = frame;
    row.assessment.verdict = Verdict::rejected;
    journal_.record_attempt(row);
  }

  void commit(std::int64_t layer, std::int64_t shown) {
    const auto path = sample_.layer_path(layer);
    const auto stored = reconstruct::write_layer_image(
        path, photograph(shown, ++noise_), {layer, sample_.description().cuboid.spacing}, {});
    AttemptRow row;
    row.layer = layer;
    row.attempt = ++attempt_;
    row.taken_at = now();
    row.frame_sequence = static_cast<std::uint64_t>(frame_);
    row.file = std::filesystem::relative(path, sample_.path());
    row.sha256 = stored.sha256;
    row.assessment.verdict = Verdict::accepted;
    journal_.commit_layer(row, stored.bytes, now());
  }
  void commit(std::int64_t layer) { commit(layer, layer); }

  void make(std::int64_t layer) {
    grind(layer);
    take_frame(layer);
    commit(layer);
  }
  void make_from(std::int64_t layer) {
    for (; layer <= kLayers; ++layer) make(layer);
  }

  void record_search(std::int64_t layer, const std::vector<double>& columns_um) {
    FocusRow row;
    row.layer = layer;
    row.found = true;
    for (const double column_um : columns_um) row.points.push_back({{column_um}, 0.1});
    journal_.record_focus(row, now());
  }

  void note(const char* kind, const char* text, const char* state = "preflight") {
    journal_.record_event({.kind = kind, .state = state, .layer = 1, .text = text, .at = now()});
  }
  void alarm(const char* state) { note("alarm", "made up", state); }

  void kill(std::int64_t committed) { kills_.push_back({now(), committed}); }

  void photograph_in_the_dark() { lamp_on_ = false; }

  const SampleFolder& sample() const { return sample_; }

  FinishedRun finished() const {
    return {folder_ / "witness.jsonl", sample_.path(), kLayers, kFirstFaceUm, kThicknessUm, kills_};
  }

 private:
  std::filesystem::path folder_;
  SampleFolder sample_;
  LayerJournal journal_;
  int second_ = 0;
  std::uint32_t sequence_ = 0;
  int frame_ = 0;
  int noise_ = 0;
  int attempt_ = 0;
  bool lamp_on_ = true;
  std::vector<Killed> kills_;
};

class RunJudge : public testing::Test {
 protected:
  RunJudge() {
    for (std::int64_t layer = 1; layer <= kLayers; ++layer) {
      reconstruct::write_layer_image(undisturbed_.layer_path(layer),
                                     photograph(layer, 1000 + static_cast<int>(layer)),
                                     {layer, {10.0, 10.0, kThicknessUm}}, {});
    }
  }

  std::vector<std::string> verdict() const { return judge(run.finished(), undisturbed_.path()); }

  TemporaryFolder folder_;
  MadeUpRun run{folder_.path()};

 private:
  SampleFolder undisturbed_ = new_sample(folder_ / "undisturbed");
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
              {{"sequence", 2}, {"action", "grind_pass"}, {"position_um", face_um(2)}});
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

TEST_F(RunJudge, AllowsAnAlarmTheSearchThatItBrokeOffAndNoOtherFrame) {
  run.grind(1);
  run.take_frame(1);
  run.alarm("focusing");
  run.take_frame(1);
  run.alarm("capturing");
  run.take_frame(1);
  run.commit(1);
  run.make_from(2);
  EXPECT_THAT(verdict(), ElementsAre(HasSubstr("frame 2 of ")));
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
