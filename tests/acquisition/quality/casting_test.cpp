#include "acquisition/quality/casting.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "acquisition/quality/thumbnail.hpp"
#include "tests/acquisition/quality/phantom_photographer.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

const PhotographerSettings kWholeSpecimen{
    .width = 512, .height = 512, .pixel_um = 20.0, .left_um = 0.0, .top_um = 0.0};

TEST(Casting, IsLearntFromTheBorderOfASpecimensPicture) {
  const cv::Mat cells = take_thumbnail(PhantomPhotographer(kWholeSpecimen).photograph(400.0));
  const auto casting = learn_casting(cells);
  ASSERT_TRUE(casting);
  // The phantom's: 52, 118, 78 of 255, less what vignetting takes of the border.
  EXPECT_NEAR(casting->level[0], 0.20, 0.02);
  EXPECT_NEAR(casting->level[1], 0.45, 0.03);
  EXPECT_NEAR(casting->level[2], 0.30, 0.02);
  EXPECT_GT(casting->share, 0.25);
  EXPECT_LT(casting->share, 0.45);
  const cv::Mat mask = casting_cells(cells, *casting);
  EXPECT_EQ(mask.at<std::uint8_t>(0, 0), 255);
  EXPECT_EQ(mask.at<std::uint8_t>(mask.rows / 2, mask.cols / 2), 0);
}

TEST(Casting, IsNotLearntWhereTheBorderHasManyColours) {
  EXPECT_FALSE(learn_casting(take_thumbnail(PhantomPhotographer({}).photograph(400.0))));
  EXPECT_FALSE(learn_casting(cv::Mat()));
}

TEST(Casting, IsNotThereWhenTooFewCellsShowIt) {
  const cv::Mat cells(40, 40, CV_32FC3, cv::Scalar(0.2, 0.45, 0.3));
  cv::Mat mask = cv::Mat::zeros(cells.size(), CV_8UC1);
  mask(cv::Rect(0, 0, 31, 1)).setTo(255);
  EXPECT_FALSE(casting_within(cells, mask, {}));
  mask.at<std::uint8_t>(1, 0) = 255;
  ASSERT_TRUE(casting_within(cells, mask, {}));
  EXPECT_NEAR(casting_within(cells, mask, {})->level[1], 0.45, 1e-6);
}

}  // namespace
}  // namespace biotomy::tests
