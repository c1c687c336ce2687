#include "acquisition/quality/thumbnail.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace biotomy::tests {
namespace {

using acquisition::take_thumbnail;

TEST(Thumbnail, HoldsTheMeanColoursOfItsCells) {
  for (const int type : {CV_8UC3, CV_16UC3}) {
    const double full = type == CV_8UC3 ? 255.0 : 65535.0;
    cv::Mat image(19, 27, type, cv::Scalar(full, full, full));  // 3 columns and rows are left over
    image(cv::Rect(8, 0, 8, 4)).setTo(cv::Scalar(0, full, 0));
    const cv::Mat cells = take_thumbnail(image);
    ASSERT_EQ(cells.size(), cv::Size(3, 2));
    EXPECT_EQ(cells.at<cv::Vec3f>(1, 2), cv::Vec3f(1.0F, 1.0F, 1.0F));
    EXPECT_LT(cv::norm(cells.at<cv::Vec3f>(0, 1), cv::Vec3f(0.5F, 1.0F, 0.5F)), 1e-6);
  }
}

TEST(Thumbnail, OfLessThanACellIsEmpty) {
  EXPECT_TRUE(take_thumbnail(cv::Mat(7, 100, CV_8UC3)).empty());
}

}  // namespace
}  // namespace biotomy::tests
