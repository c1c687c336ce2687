#include "acquisition/quality/noise_judgement.hpp"

#include <memory>

#include <gtest/gtest.h>

#include "tests/acquisition/quality/phantom_photographer.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

constexpr double kDepth = 100.0;

/// Frames of one face by a camera with one chip, from its corner on, where there is little detail.
struct Photographed {
  PhantomPhotographer camera{
      {.width = 480, .height = 480, .left_um = 0.0, .top_um = 0.0, .sensor = {.mosaic = true}}};
  SharpnessRecord record;

  SharpnessRecord::Frame frame() {
    return std::make_shared<const FrameMeasures>(measure_frame(camera.photograph(kDepth)));
  }
  Assessment judge(std::int64_t layer) {
    Judgement judgement;
    judgement.result().measures = frame();
    judge_noise(layer, record, judgement);
    return judgement.finish();
  }
};

double fine_noise(const FrameMeasures& measures) {
  return measures.tiles.front().noise[DetailBand::fine];
}

TEST(NoiseJudgement, LearnsTheNoiseAtOnceWhereNoneIsKnown) {
  Photographed photographed;
  const auto peak = photographed.frame();
  photographed.record.found_focus(1, peak);
  const Assessment judged = photographed.judge(1);
  ASSERT_TRUE(judged.noise);
  EXPECT_TRUE(photographed.record.noise());
  EXPECT_GT(fine_noise(*judged.measures), 2.0 * fine_noise(*peak));
  // What the frame is compared with is expressed likewise.
  EXPECT_NEAR(fine_noise(*photographed.record.peak()) / fine_noise(*judged.measures), 1.0, 0.05);
}

TEST(NoiseJudgement, NotesWhatItLearnt) {
  Photographed photographed;
  photographed.record.found_focus(1, photographed.frame());
  const Assessment judged = photographed.judge(1);
  ASSERT_TRUE(judged.noise);
  const auto noted = noise_noted(judged.metrics);
  ASSERT_TRUE(noted && noted->face);
  for (std::size_t band = 0; band < kDetailBands; ++band) {
    EXPECT_DOUBLE_EQ(noted->bands.values[band].at(0.5), judged.noise->bands.values[band].at(0.5));
  }
  EXPECT_DOUBLE_EQ(noted->face->at(0.5), judged.noise->face->at(0.5));
  for (const Metric& metric : judged.metrics) EXPECT_TRUE(metric.passed) << metric.name;
}

TEST(NoiseJudgement, KeepsWhatIsKnownUntilTheFrameIsAccepted) {
  Photographed photographed;
  CameraNoise known;
  known.bands[DetailBand::fine] = {.dark = 1e-5, .light = 0.0};
  photographed.record.know_noise(known);
  photographed.record.found_focus(2, photographed.frame());
  const Assessment judged = photographed.judge(2);
  EXPECT_TRUE(judged.noise);
  EXPECT_DOUBLE_EQ(fine_noise(*judged.measures), 1e-5);
}

TEST(NoiseJudgement, LearnsNothingFromASearchOfAnotherFace) {
  Photographed photographed;
  photographed.record.found_focus(1, photographed.frame());
  const Assessment judged = photographed.judge(2);
  EXPECT_FALSE(judged.noise);
  EXPECT_FALSE(photographed.record.noise());
  EXPECT_FALSE(noise_noted(judged.metrics));
}

}  // namespace
}  // namespace biotomy::tests
