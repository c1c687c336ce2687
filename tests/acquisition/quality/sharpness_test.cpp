#include "acquisition/quality/sharpness.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/acquisition/fake_rig.hpp"

namespace biotomy::tests {
namespace {

using acquisition::sharpness;

TEST(Sharpness, FallsWithEachStepOfBlur) {
  double last = 1e9;
  for (const double sigma : {0.5, 1.0, 1.5, 2.0, 3.0, 5.0}) {
    const double value = sharpness(chequered_face(200, 200, sigma));
    EXPECT_LT(value, last) << sigma;
    last = value;
  }
}

TEST(Sharpness, DoesNotDependOnTheExposure) {
  const cv::Mat face = chequered_face(200, 200, 1.0);
  cv::Mat dim;
  face.convertTo(dim, CV_8U, 0.5);
  EXPECT_NEAR(sharpness(dim) / sharpness(face), 1.0, 0.03);
}

TEST(Sharpness, IsTheSameWithEightAndSixteenBits) {
  const cv::Mat face = chequered_face(200, 200, 1.0);
  cv::Mat deep;
  face.convertTo(deep, CV_16U, 257.0);
  EXPECT_NEAR(sharpness(deep) / sharpness(face), 1.0, 0.02);
}

TEST(Sharpness, OfABlackOrEmptyImageIsZero) {
  EXPECT_EQ(sharpness(cv::Mat(10, 10, CV_8UC3, cv::Scalar::all(0))), 0.0);
  EXPECT_EQ(sharpness(cv::Mat()), 0.0);
}

}  // namespace
}  // namespace biotomy::tests
