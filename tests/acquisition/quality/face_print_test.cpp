#include "acquisition/quality/face_print.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/acquisition/fake_rig.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

double energy(const cv::Mat& patch) {
  return patch.dot(patch) / static_cast<double>(patch.total());
}

TEST(FacePrint, OfALargeFrameIsAFewPatchesThatTakeLittleMemory) {
  const FacePrint print = take_face_print(cv::Mat(4000, 5000, CV_8UC3, cv::Scalar::all(90)));
  ASSERT_EQ(print.patches.size(), 64U);
  std::size_t bytes = 0;
  for (const FacePrint::Patch& patch : print.patches) {
    EXPECT_EQ(patch.detail.size(), cv::Size(96 + 10, 96 + 10));
    bytes += patch.detail.total() * patch.detail.elemSize() +
             patch.noise.total() * patch.noise.elemSize();
  }
  EXPECT_LT(bytes, 6'000'000U);
}

TEST(FacePrint, OfATinyFrameHasNoPatches) {
  const FacePrint print = take_face_print(cv::Mat(40, 40, CV_8UC3, cv::Scalar::all(90)));
  EXPECT_TRUE(print.patches.empty());
  EXPECT_EQ(print.frame_rows->rows.size(), 40U);
}

TEST(FacePrint, HasNoDetailOnAnEvenFaceAndKnowsHowStrongTheNoiseIs) {
  cv::Mat image(320, 320, CV_8UC3, cv::Scalar(90, 140, 100));
  add_noise(image, 1);
  double detail = 0.0;
  double noise = 0.0;
  for (const FacePrint::Patch& patch : take_face_print(image).patches) {
    detail += energy(patch.detail);
    noise += energy(patch.noise);
  }
  EXPECT_GT(noise, 0.0);
  EXPECT_NEAR(detail / noise, 1.0, 0.1);
}

TEST(FacePrint, DoesNotSeeHowTheLightFallsOff) {
  cv::Mat image(400, 400, CV_16UC3);
  for (int y = 0; y < image.rows; ++y) {
    image.row(y).setTo(cv::Scalar::all(257.0 * (100.0 + 0.2 * y)));
  }
  for (const FacePrint::Patch& patch : take_face_print(image).patches) {
    EXPECT_LT(std::sqrt(energy(patch.detail)), 0.01 * 257.0);
  }
}

TEST(FacePrint, IsTheSameWithEightAndSixteenBits) {
  const cv::Mat face = chequered_face(160, 120, 2.0);
  cv::Mat deep;
  face.convertTo(deep, CV_16U, 257.0);
  const FacePrint of_eight = take_face_print(face);
  const FacePrint of_sixteen = take_face_print(deep);
  for (std::size_t i = 0; i < of_eight.patches.size(); ++i) {
    EXPECT_LT(cv::norm(of_eight.patches[i].detail, of_sixteen.patches[i].detail, cv::NORM_INF),
              1e-6);
    EXPECT_NEAR(of_eight.patches[i].brightness, of_sixteen.patches[i].brightness, 1e-6);
  }
}

}  // namespace
}  // namespace biotomy::tests
