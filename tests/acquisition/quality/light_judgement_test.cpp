#include "acquisition/quality/light_judgement.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/acquisition/quality/surface_watch.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;

cv::Mat lit(const cv::Mat& image, const cv::Scalar& factors) {
  cv::Mat result;
  cv::multiply(image, factors, result);
  return result;
}

cv::Mat lit_from_the_right(const cv::Mat& image, double difference) {
  cv::Mat result = image.clone();
  for (int x = 0; x < image.cols; ++x) {
    result.col(x) = image.col(x) * (1.0 + difference * ((x + 0.5) / image.cols - 0.5));
  }
  return result;
}

TEST(LightJudgement, SeesALampThatGivesATenthMoreOrLess) {
  SurfaceWatch watch;
  watch.accept_layers(3);
  const cv::Mat face = watch.next_face();
  const Assessment darker = watch.judge(lit(face, cv::Scalar::all(0.9)));
  EXPECT_EQ(darker.slug, "darker");
  EXPECT_THAT(darker.reason, HasSubstr("beside the last layers', more than 0.050"));
  EXPECT_NEAR(value_of(darker, "brightness"), -0.1, 0.01);
  EXPECT_EQ(watch.judge(lit(face, cv::Scalar::all(1.1))).slug, "brighter");
  EXPECT_EQ(watch.judge(lit(face, cv::Scalar::all(0.98))).verdict, Verdict::accepted);
}

TEST(LightJudgement, SeesLightThatIsUneven) {
  SurfaceWatch watch;
  watch.accept_layers(3);
  const cv::Mat face = watch.next_face();
  const Assessment uneven = watch.judge(lit_from_the_right(face, 0.15));
  EXPECT_EQ(uneven.slug, "uneven-light");
  EXPECT_NEAR(value_of(uneven, "evenness"), 0.15, 0.04);
  EXPECT_EQ(watch.judge(lit_from_the_right(face, 0.03)).verdict, Verdict::accepted);
}

TEST(LightJudgement, SeesACastOfOneColour) {
  SurfaceWatch watch;
  watch.accept_layers(3);
  const cv::Mat face = watch.next_face();
  for (const cv::Scalar& factors :
       {cv::Scalar(1.06, 1, 1), cv::Scalar(1, 0.94, 1), cv::Scalar(1, 1, 1.06)}) {
    const Assessment cast = watch.judge(lit(face, factors));
    EXPECT_EQ(cast.slug, "colour-cast");
    EXPECT_NEAR(value_of(cast, "colour_cast"), 0.06, 0.01);
  }
  EXPECT_EQ(watch.judge(lit(face, cv::Scalar(1.015, 1, 1))).verdict, Verdict::accepted);
}

TEST(LightJudgement, SeesADriftThatNoLayerShows) {
  SurfaceWatch watch;
  watch.accept_layers(1);
  std::string slug;
  double light = 1.0;
  while (light > 0.5 && (slug.empty() || slug == "good")) {
    light *= 0.995;
    slug = watch.accept(lit(watch.next_face(), cv::Scalar::all(light))).slug;
  }
  EXPECT_EQ(slug, "light-drifted");
  EXPECT_NEAR(light, 0.75, 0.05);
}

TEST(LightJudgement, LearnsNothingFromAColourThatTheCastingMaterialHasNot) {
  SurfaceWatch watch;
  const auto without_red = [](const cv::Mat& image) { return lit(image, cv::Scalar(0, 1, 1)); };
  for (int layer = 0; layer < 3; ++layer) {
    const Assessment judged = watch.accept(without_red(watch.next_face()));
    EXPECT_EQ(judged.verdict, Verdict::accepted) << judged.reason;
    for (const Metric& metric : judged.metrics) {
      EXPECT_TRUE(std::isfinite(metric.value)) << metric.name;
    }
  }
}

TEST(LightJudgement, ComparesWithTheCastingMaterialOfALayerOfLongAgo) {
  SurfaceWatch watch;
  watch.record.recall({.level = {0.3, 0.45, 0.3}});
  const Assessment first = watch.judge(watch.next_face());
  EXPECT_EQ(first.slug, "colour-drifted");
  EXPECT_NEAR(value_of(first, kCastingMetrics[1]), 0.45, 0.03);
}

TEST(LightJudgement, LeavesOpenWhatTooLittleIsSteadyFor) {
  SurfaceWatch watch;
  const auto noise = [](std::uint64_t seed) {
    cv::Mat image(64, 64, CV_8UC3);
    cv::Mat squares(8, 8, CV_8UC3);
    cv::RNG(seed).fill(squares, cv::RNG::UNIFORM, 40, 200);
    cv::resize(squares, image, image.size(), 0.0, 0.0, cv::INTER_NEAREST);
    return image;
  };
  watch.thresholds.maximum_debris = 1.0;
  watch.accept(noise(1));
  const Assessment other = watch.judge(noise(2));
  EXPECT_EQ(other.verdict, Verdict::accepted) << other.reason;
  EXPECT_THAT(other.reason, HasSubstr("too little that is steady"));
  EXPECT_FALSE(is_judged(other, "evenness"));
}

}  // namespace
}  // namespace biotomy::tests
