#include "acquisition/quality/sharpness_judgement.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "tests/acquisition/quality/phantom_photographer.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;

constexpr double kSlightlyOut = 60.0;  // leaves 0.93 of the sharpness
constexpr double kFarOut = 150.0;

struct Judged {
  PhantomPhotographer camera{{.width = 480, .height = 480}};
  SharpnessRecord record;
  QualityThresholds thresholds;

  SharpnessRecord::Frame frame(int layer, double defocus_um = 0.0) {
    return std::make_shared<const FrameMeasures>(
        measure_frame(camera.photograph(20.0 * layer, 0.0, 0.0, defocus_um)));
  }
  Assessment judge(int layer, double defocus_um = 0.0) {
    Judgement judgement;
    judgement.result().measures = frame(layer, defocus_um);
    judge_sharpness(record, layer, thresholds, judgement);
    return judgement.finish();
  }
};

TEST(SharpnessJudgement, ComparesWithTheLastLayers) {
  Judged judged;
  for (int layer = 1; layer <= 4; ++layer) judged.record.accept(judged.frame(layer));
  EXPECT_EQ(judged.judge(5).verdict, Verdict::accepted);
  const Assessment blurred = judged.judge(5, kFarOut);
  EXPECT_EQ(blurred.slug, "blurred");
  EXPECT_THAT(blurred.reason, HasSubstr("of the last layers', below 0."));
  EXPECT_THAT(blurred.reason, HasSubstr(" tiles"));
  EXPECT_FALSE(blurred.sharpness_to_peak);
}

TEST(SharpnessJudgement, ComparesWithThisLayersSearchWhereThereWasOne) {
  Judged judged;
  for (int layer = 1; layer <= 4; ++layer) judged.record.accept(judged.frame(layer));
  judged.record.found_focus(5, judged.frame(5, kSlightlyOut));
  const Assessment as_found = judged.judge(5, kSlightlyOut);
  EXPECT_EQ(as_found.verdict, Verdict::accepted) << as_found.reason;
  EXPECT_NEAR(as_found.sharpness_to_peak.value(), 1.0, 0.02);
  EXPECT_THAT(judged.judge(5, kFarOut).reason, HasSubstr("of this layer's focus peak"));
}

TEST(SharpnessJudgement, SeesBlurThroughTheNoiseOfACameraWithOneChip) {
  // Where there is little detail and little light: casting material at a high gain.
  PhotographerSettings settings{.width = 640, .height = 480, .left_um = 0.0, .top_um = 0.0};
  settings.sensor = {.mosaic = true, .photons_at_white = 1000};
  PhantomPhotographer camera(settings);
  const auto frame = [&](int layer, double defocus_um) {
    return std::make_shared<const FrameMeasures>(
        measure_frame(camera.photograph(20.0 * layer, 0.0, 0.0, defocus_um)));
  };
  SharpnessRecord record;
  for (int layer = 1; layer <= 3; ++layer) record.accept(frame(layer, 0.0));
  const auto verdict = [&](double defocus_um) {
    Judgement judgement;
    judgement.result().measures = record.expressed(frame(4, defocus_um));
    judge_sharpness(record, 4, {}, judgement);
    return judgement.finish().verdict;
  };
  constexpr double kOut = 80.0;  // leaves 0.88 of the sharpness
  EXPECT_EQ(verdict(kOut), Verdict::accepted) << "its noise passes for detail";
  const auto noise = noise_between(*frame(3, 0.0), *frame(3, 0.0));
  ASSERT_TRUE(noise);
  record.know_noise(*noise);
  EXPECT_EQ(verdict(kOut), Verdict::rejected);
  EXPECT_EQ(verdict(0.0), Verdict::accepted);
}

TEST(SharpnessJudgement, SeesThatAThirdOfTheFrameIsBlurredWhateverTheMedianSays) {
  Judged judged;
  for (int layer = 1; layer <= 4; ++layer) judged.record.accept(judged.frame(layer));
  const cv::Mat sharp = judged.camera.photograph(100.0);
  const cv::Mat blurred = judged.camera.photograph(100.0, 0.0, 0.0, kFarOut);
  const cv::Rect part(0, 0, sharp.cols, sharp.rows / 3);
  blurred(part).copyTo(sharp(part));
  Judgement judgement;
  judgement.result().measures = std::make_shared<const FrameMeasures>(measure_frame(sharp));
  judge_sharpness(judged.record, 5, judged.thresholds, judgement);
  const Assessment assessment = judgement.finish();
  const auto found = std::ranges::find(assessment.metrics, "blurred_part", &Metric::name);
  ASSERT_NE(found, assessment.metrics.end());
  EXPECT_FALSE(found->passed);
  EXPECT_NEAR(found->value, 1.0 / 3.0, 0.15);
  EXPECT_EQ(assessment.slug, "blurred");
}

TEST(SharpnessJudgement, MistrustsASearchThatFoundAMuchWorseFocusThanTheLayersBefore) {
  Judged judged;
  for (int layer = 1; layer <= 4; ++layer) judged.record.accept(judged.frame(layer));
  judged.record.found_focus(5, judged.frame(5, kFarOut));
  EXPECT_THAT(judged.judge(5, kFarOut).reason, HasSubstr("although the focus was searched"));
}

TEST(SharpnessJudgement, TellsTheFocusHowFarTheSharpnessFellSinceItsLastSearch) {
  Judged judged;
  judged.record.found_focus(4, judged.frame(4));
  for (int layer = 1; layer <= 4; ++layer) judged.record.accept(judged.frame(layer, kSlightlyOut));
  const Assessment drifted = judged.judge(5, kSlightlyOut);
  EXPECT_EQ(drifted.verdict, Verdict::accepted) << drifted.reason;
  EXPECT_LT(drifted.sharpness_to_peak.value(), 0.98);
}

TEST(SharpnessJudgement, LeavesItOpenWithoutAnythingToCompareWith) {
  Judged judged;
  const Assessment first = judged.judge(1);
  EXPECT_EQ(first.verdict, Verdict::accepted);
  EXPECT_THAT(first.reason, HasSubstr("nothing to compare the sharpness with"));
}

TEST(SharpnessRecord, RemembersAFewLayers) {
  Judged judged;
  const SharpnessRecord::Frame frame = judged.frame(1);
  for (int i = 0; i < 20; ++i) judged.record.accept(frame);
  EXPECT_EQ(judged.record.recent().size(), SharpnessRecord::kRemembered);
}

}  // namespace
}  // namespace biotomy::tests
