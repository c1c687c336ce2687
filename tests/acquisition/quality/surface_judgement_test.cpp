#include "acquisition/quality/surface_judgement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/acquisition/quality/surface_watch.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;
using testing::Not;

const cv::Scalar kChip(206, 214, 206);  // as the twin's: frosted casting material

/// Discs of 6 pixels strewn over an image: each 0.04 % of it.
cv::Mat strewn(cv::Mat image, int count, const cv::Scalar& colour) {
  cv::RNG places(9);
  for (int i = 0; i < count; ++i) {
    cv::circle(image, {places.uniform(0, image.cols), places.uniform(0, image.rows)}, 6, colour,
               cv::FILLED);
  }
  return image;
}

cv::Mat veiled(cv::Mat image, const cv::Rect& part, double opacity) {
  cv::Mat under = image(part);
  under = under * (1.0 - opacity) + cv::Scalar(228, 236, 240) * opacity;
  return image;
}

TEST(SurfaceJudgement, SeesDebris) {
  SurfaceWatch watch;
  watch.accept_layers(3);
  const Assessment dirty = watch.judge(strewn(watch.next_face(), 20, kChip));
  EXPECT_EQ(dirty.slug, "debris");
  EXPECT_THAT(dirty.reason, HasSubstr("nowhere near, more than 0.00"));
  EXPECT_GT(value_of(dirty, "debris"), 0.003);  // discs of 0.9 % of the frame
  EXPECT_LT(value_of(dirty, "debris"), 0.03);
}

TEST(SurfaceJudgement, SeesDebrisOfADarkColourToo) {
  SurfaceWatch watch;
  watch.accept_layers(3);
  EXPECT_EQ(watch.judge(strewn(watch.next_face(), 20, cv::Scalar(10, 10, 60))).slug, "debris");
}

TEST(SurfaceJudgement, SeesAPartInShadowHoweverDarkItIs) {
  SurfaceWatch watch;
  watch.accept_layers(3);
  const Assessment clean = watch.judge(watch.next_face());
  EXPECT_EQ(clean.verdict, Verdict::accepted) << clean.reason;
  EXPECT_EQ(value_of(clean, "shade"), 0.0);
  for (const double light : {0.85, 0.7, 0.3, 0.0}) {
    cv::Mat image = watch.next_face();
    cv::Mat part = image(cv::Rect(0, 0, 3 * image.cols / 10, image.rows));
    part = part * light;
    const Assessment shaded = watch.judge(image);
    EXPECT_EQ(shaded.verdict, Verdict::rejected) << light;
    EXPECT_NEAR(value_of(shaded, "shade"), 0.3, 0.05) << light;
  }
}

TEST(SurfaceJudgement, ExpectsMoreNewColoursAfterALayerInWhichTissueCameUp) {
  SurfaceWatch watch;
  watch.accept_layers(2);
  const Assessment last = watch.judge(watch.next_face());
  const cv::Mat dirty = strewn(watch.camera.photograph(80.0), 20, kChip);
  watch.record.accept(3, last.surface, last.light, 0.0);
  const Assessment after_a_quiet_layer = watch.judge(dirty);
  EXPECT_EQ(after_a_quiet_layer.slug, "debris");
  watch.record.accept(3, last.surface, last.light, 0.5);
  const Assessment after_an_arrival = watch.judge(dirty);
  EXPECT_EQ(after_an_arrival.verdict, Verdict::accepted) << after_an_arrival.reason;
  EXPECT_EQ(value_of(after_an_arrival, "debris"), value_of(after_a_quiet_layer, "debris"));
}

TEST(SurfaceJudgement, SeesGlare) {
  SurfaceWatch watch;
  watch.accept_layers(3);
  const Assessment glaring = watch.judge(strewn(watch.next_face(), 5, cv::Scalar::all(255)));
  EXPECT_EQ(glaring.slug, "glare");
  EXPECT_THAT(glaring.reason, HasSubstr("reflects the lamp"));
}

TEST(SurfaceJudgement, SeesFrost) {
  SurfaceWatch watch;
  watch.accept_layers(3);
  const Assessment frosted = watch.judge(veiled(watch.next_face(), {0, 0, 512, 160}, 0.25));
  EXPECT_EQ(frosted.slug, "frost");
  EXPECT_GT(value_of(frosted, "frost"), 0.1);
  const Assessment hardly = watch.judge(veiled(watch.next_face(), {0, 0, 512, 160}, 0.02));
  EXPECT_EQ(hardly.verdict, Verdict::accepted) << hardly.reason;
}

TEST(SurfaceJudgement, SeesABlockThatMoved) {
  SurfaceWatch watch;
  watch.accept_layers(2);
  const Assessment moved = watch.judge(watch.camera.photograph(60.0, -5.0, 2.0));
  EXPECT_EQ(moved.slug, "shifted");
  EXPECT_THAT(moved.reason, HasSubstr("beside where it lay in layer 2, more than 3.00"));
  EXPECT_NEAR(value_of(moved, "shift_x"), 5.0, 0.4);
  EXPECT_NEAR(value_of(moved, "shift_y"), -2.0, 0.4);
  EXPECT_EQ(watch.judge(watch.camera.photograph(60.0, 0.5, 0.5)).verdict, Verdict::accepted);
}

TEST(SurfaceJudgement, SaysSoWhenItCannotTellWhereTheBlockLies) {
  SurfaceWatch watch;
  const auto noise = [](std::uint64_t seed) {
    cv::Mat image(512, 512, CV_8UC3);
    cv::RNG(seed).fill(image, cv::RNG::NORMAL, 100.0, 3.0);
    return image;
  };
  EXPECT_THAT(watch.accept(noise(1)).reason, Not(HasSubstr("where the block lies")));
  const Assessment second = watch.judge(noise(2));
  EXPECT_FALSE(is_judged(second, "shift"));
  EXPECT_EQ(second.verdict, Verdict::accepted);
  EXPECT_THAT(second.reason, HasSubstr("too little grain to tell where the block lies"));
}

TEST(SurfaceJudgement, JudgesNothingWithoutALayerBefore) {
  SurfaceWatch watch;
  const Assessment first = watch.judge(strewn(watch.next_face(), 20, kChip));
  EXPECT_EQ(first.verdict, Verdict::accepted);
  EXPECT_FALSE(is_judged(first, "debris"));
}

TEST(SurfaceJudgement, AcceptsASpecimenThatAppearsAllAtOnceAndGoesAgain) {
  SurfaceWatch watch;
  const cv::Mat casting = watch.camera.photograph(0.0)(cv::Rect(0, 0, 40, 512)).clone();
  const auto empty = [&](std::uint64_t exposure) {
    cv::Mat image;
    cv::repeat(casting, 1, 13, image);
    image = image(cv::Rect(0, 0, 512, 512)).clone();
    cv::Mat noise(image.size(), CV_8UC3);
    cv::RNG(exposure).fill(noise, cv::RNG::UNIFORM, 0, 3);
    image += noise;
    return image;
  };
  watch.accept(empty(1));
  watch.accept(empty(2));
  const Assessment entering = watch.accept(watch.next_face());
  EXPECT_EQ(entering.verdict, Verdict::accepted) << entering.reason;
  watch.accept_layers(3);
  const Assessment leaving = watch.accept(empty(3));
  EXPECT_EQ(leaving.verdict, Verdict::accepted) << leaving.reason;
}

}  // namespace
}  // namespace biotomy::tests
