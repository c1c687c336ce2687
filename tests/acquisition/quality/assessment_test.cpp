#include "acquisition/quality/assessment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/acquisition/fake_rig.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;

struct Judged {
  bridge::Frame frame;
  FrameExpectation expectation;

  Judged() {
    frame.image = ground_face(96, 64, 0.6, 1000.0);
    frame.sequence = 5;
    expectation = {.width = 96, .height = 64, .type = CV_8UC3, .layer = 1, .previous_sequence = 4};
    expectation.sharpness.found_focus(
        1, std::make_shared<const FrameMeasures>(measure_frame(frame.image)));
  }
  Assessment assessment() const { return assess(frame, expectation, {}); }
};

TEST(Assessment, AcceptsAFrameAsSharpAsTheFocusPeak) {
  const Assessment good = Judged().assessment();
  EXPECT_EQ(good.verdict, Verdict::accepted);
  EXPECT_NEAR(good.sharpness_to_peak.value(), 1.0, 1e-9);
  EXPECT_EQ(good.metrics.size(), 11U);  // with what is learnt of the casting material
}

TEST(Assessment, RejectsABlurredFrameAndSaysHowMuch) {
  Judged judged;
  judged.frame.image = ground_face(96, 64, 1.5, 1000.0);
  const Assessment blurred = judged.assessment();
  EXPECT_EQ(blurred.verdict, Verdict::rejected);
  EXPECT_EQ(blurred.slug, "blurred");
  EXPECT_THAT(blurred.reason, HasSubstr("of this layer's focus peak, below "));
}

TEST(Assessment, TellsAFrameThatLacksOnlySharpnessFromOthers) {
  Judged judged;
  EXPECT_FALSE(judged.assessment().lacks_only_sharpness);
  judged.frame.image = ground_face(96, 64, 0.75, 1000.0);
  EXPECT_EQ(judged.assessment().slug, "blurred");
  EXPECT_TRUE(judged.assessment().lacks_only_sharpness);
  judged.frame.image *= 0.1;  // and too dark
  EXPECT_FALSE(judged.assessment().lacks_only_sharpness);
}

// Of whatever face it is, it counts as changed.
TEST(Assessment, DoesNotSayThatAFrameWhoseDetailIsGoneLacksOnlySharpness) {
  Judged judged;
  const auto face = [](double sigma, double depth_um) {
    cv::Mat image = ground_face(96, 64, sigma, depth_um);
    add_noise(image, static_cast<std::uint64_t>(depth_um));
    return image;
  };
  judged.expectation.layer = 2;
  judged.expectation.faces.accept(
      1, std::make_shared<const FacePrint>(take_face_print(face(0.6, 980.0))), {});
  judged.frame.image = face(0.75, 1000.0);
  EXPECT_TRUE(judged.assessment().lacks_only_sharpness) << judged.assessment().reason;
  judged.frame.image = face(12.0, 1000.0);
  EXPECT_EQ(judged.assessment().slug, "blurred");
  EXPECT_TRUE(judged.assessment().shows_the_face);
  EXPECT_FALSE(judged.assessment().lacks_only_sharpness);
}

TEST(Assessment, RejectsABlackFrame) {
  Judged judged;
  judged.frame.image.setTo(cv::Scalar::all(2));
  EXPECT_EQ(judged.assessment().slug, "too-dark");
}

TEST(Assessment, RejectsAFrameWithAColourAtFullScale) {
  Judged judged;
  judged.frame.image(cv::Rect(0, 0, 48, 64)).setTo(cv::Scalar(255, 90, 90));  // red alone
  const Assessment clipped = judged.assessment();
  EXPECT_EQ(clipped.slug, "clipped");
  EXPECT_THAT(clipped.reason, HasSubstr("0.5000 of the pixels"));
}

TEST(Assessment, RejectsAFrameOfAnEarlierMoment) {
  Judged judged;
  judged.frame.sequence = 4;
  EXPECT_EQ(judged.assessment().slug, "stale");
}

TEST(Assessment, RejectsAFrameOfAnotherSizeOrDepth) {
  Judged judged;
  judged.expectation.width = 97;
  EXPECT_EQ(judged.assessment().slug, "wrong-size");
  EXPECT_THAT(judged.assessment().reason, HasSubstr("96 × 64 of 8 bits"));
  judged.expectation.width = 96;
  judged.expectation.type = CV_16UC3;
  EXPECT_EQ(judged.assessment().slug, "wrong-size");
}

}  // namespace
}  // namespace biotomy::tests
