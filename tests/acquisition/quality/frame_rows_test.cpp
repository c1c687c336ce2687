#include "acquisition/quality/frame_rows.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/acquisition/fake_rig.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

cv::Mat exposure(std::uint64_t number, int width = 96, int height = 64) {
  cv::Mat image = chequered_face(width, height, 1.0);
  add_noise(image, number);
  return image;
}

cv::Rect rows(const cv::Mat& image, int from, int to) {
  return {0, from, image.cols, to - from};
}

TEST(FrameRows, OfTwoExposuresOfOneFaceHaveNoneInCommon) {
  const RepeatedRows count = repeated_rows(rows_of(exposure(2)), rows_of(exposure(1)));
  EXPECT_EQ(count.repeated, 0);
  EXPECT_EQ(count.noisy, 64);
}

TEST(FrameRows, OfTheSamePictureAreAllRepeated) {
  const RepeatedRows count = repeated_rows(rows_of(exposure(1)), rows_of(exposure(1)));
  EXPECT_EQ(count.repeated, 64);
  EXPECT_EQ(count.noisy, 64);
}

TEST(FrameRows, OfATornFrameAreRepeatedFromTheTearOn) {
  const cv::Mat before = exposure(1);
  cv::Mat torn = exposure(2);
  before(rows(before, 40, 64)).copyTo(torn(rows(torn, 40, 64)));
  EXPECT_EQ(repeated_rows(rows_of(torn), rows_of(before)).repeated, 24);
}

TEST(FrameRows, ThatAreLongerThanWhatIsLookedAtWithoutGapsAreRecognisedToo) {
  const cv::Mat before = exposure(1, 4000, 8);
  EXPECT_EQ(repeated_rows(rows_of(before), rows_of(before.clone())).repeated, 8);
  EXPECT_EQ(repeated_rows(rows_of(exposure(2, 4000, 8)), rows_of(before)).repeated, 0);
}

TEST(FrameRows, OfSixteenBitsAreRecognisedToo) {
  cv::Mat deep;
  exposure(1).convertTo(deep, CV_16U, 257.0);
  const RepeatedRows count = repeated_rows(rows_of(deep), rows_of(deep));
  EXPECT_EQ(count.repeated, 64);
  EXPECT_EQ(dead_share(rows_of(deep), nullptr), 0.0);
}

TEST(FrameRows, WithoutNoiseSayNothingWhenTheyAreEqual) {
  // A dark bed that is clipped to black but for a hot pixel is the same in every frame.
  cv::Mat image = exposure(1);
  image(rows(image, 0, 16)).setTo(cv::Scalar::all(0));
  image(cv::Rect(50, 0, 1, 16)).setTo(cv::Scalar::all(200));
  const RepeatedRows count = repeated_rows(rows_of(image), rows_of(image));
  EXPECT_EQ(count.noisy, 48);
  EXPECT_EQ(count.repeated, 48);
}

TEST(FrameRows, ThatWereNotReadOutAreDead) {
  cv::Mat partial = exposure(2);
  partial(rows(partial, 48, 64)).setTo(cv::Scalar::all(0));
  EXPECT_EQ(dead_share(rows_of(partial), nullptr), 0.25);
  const FrameRows whole = rows_of(exposure(1));
  EXPECT_EQ(dead_share(rows_of(partial), &whole), 0.25);
}

TEST(FrameRows, ThatNeverHoldAPictureAreNotDead) {
  cv::Mat before = exposure(1);
  before(rows(before, 48, 64)).setTo(cv::Scalar::all(0));
  cv::Mat now = exposure(2);
  now(rows(now, 48, 64)).setTo(cv::Scalar::all(0));
  const FrameRows reference = rows_of(before);
  EXPECT_EQ(dead_share(rows_of(now), &reference), 0.0);
}

TEST(FrameRows, OfABlackFrameAreAMatterOfBrightness) {
  EXPECT_EQ(dead_share(rows_of(cv::Mat(64, 96, CV_8UC3, cv::Scalar::all(1))), nullptr), 0.0);
}

}  // namespace
}  // namespace biotomy::tests
