#include "acquisition/records/rejected_frames.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/acquisition/fake_rig.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using acquisition::RejectedFrames;

TEST(RejectedFrames, AreSmallPicturesWithLayerAttemptAndReasonInTheName) {
  const TemporaryFolder folder;
  const RejectedFrames frames(folder.path(), 10, 50);
  cv::Mat red(60, 100, CV_8UC3, cv::Scalar(200, 20, 20));
  const auto path = frames.add(12, 3, "blurred", red);
  EXPECT_EQ(path.filename(), "000012-a03-blurred.jpg");
  const cv::Mat picture = cv::imread(path.string(), cv::IMREAD_COLOR);
  EXPECT_EQ(picture.cols, 50);
  EXPECT_EQ(picture.rows, 30);
  EXPECT_GT(picture.at<cv::Vec3b>(15, 25)[2], 150);  // OpenCV's last colour is red
}

TEST(RejectedFrames, OfSixteenBitsAreKeptAsWell) {
  const TemporaryFolder folder;
  const RejectedFrames frames(folder.path(), 10, 50);
  const cv::Mat deep(20, 20, CV_16UC3, cv::Scalar(40000, 40000, 40000));
  const cv::Mat picture = cv::imread(frames.add(1, 1, "stale", deep).string(), cv::IMREAD_COLOR);
  EXPECT_NEAR(picture.at<cv::Vec3b>(10, 10)[0], 40000 / 257, 3);
}

TEST(RejectedFrames, LetTheOldestGo) {
  const TemporaryFolder folder;
  const RejectedFrames frames(folder.path(), 2, 50);
  for (int layer = 9; layer <= 12; ++layer) {
    frames.add(layer, 1, "stale", chequered_face(20, 20, 1.0));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "000010-a01-stale.jpg"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "000011-a01-stale.jpg"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "000012-a01-stale.jpg"));
}

TEST(RejectedFrames, LetTheOldestGoAfterMoreThanAHundredAttempts) {
  const TemporaryFolder folder;
  const RejectedFrames frames(folder.path(), 2, 50);
  for (int attempt = 98; attempt <= 101; ++attempt) {
    frames.add(7, attempt, "stale", chequered_face(20, 20, 1.0));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "000007-a99-stale.jpg"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "000007-a100-stale.jpg"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "000007-a101-stale.jpg"));
}

}  // namespace
}  // namespace biotomy::tests
