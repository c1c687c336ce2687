#include "reconstruct/section/film.hpp"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "reconstruct/errors.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::TemporaryFolder;

constexpr int kFrames = 7;
const cv::Size kSize{160, 120};

TEST(Film, HoldsEveryFrameInOrder) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.mp4";
  Film film(path, 12.0, kSize);
  for (int i = 0; i < kFrames; ++i) {
    film.add(cv::Mat(kSize, CV_8UC3, cv::Scalar(30 * i, 100, 20)));
  }
  film.finish();

  cv::VideoCapture read(path.string(), cv::CAP_FFMPEG);
  ASSERT_TRUE(read.isOpened());
  EXPECT_NEAR(read.get(cv::CAP_PROP_FPS), 12.0, 1e-6);
  cv::Mat frame;
  int count = 0;
  while (read.read(frame)) {
    EXPECT_EQ(frame.size(), kSize);
    EXPECT_NEAR(cv::mean(frame)[2], 30 * count, 6.0);  // OpenCV reads B G R
    ++count;
  }
  EXPECT_EQ(count, kFrames);
}

TEST(Film, TakesFramesOf16Bits) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.mp4";
  Film film(path, 25.0, kSize);
  film.add(cv::Mat(kSize, CV_16UC3, cv::Scalar(257 * 200, 257 * 100, 0)));
  film.finish();
  cv::VideoCapture read(path.string(), cv::CAP_FFMPEG);
  cv::Mat frame;
  ASSERT_TRUE(read.read(frame));
  EXPECT_NEAR(cv::mean(frame)[2], 200.0, 6.0);
}

TEST(Film, IsNotThereUntilItIsFinished) {
  const TemporaryFolder folder;
  {
    Film film(folder.path() / "a.mp4", 25.0, kSize);
    film.add(cv::Mat(kSize, CV_8UC3, cv::Scalar(1, 2, 3)));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.mp4"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Film, RefusesWhatIsNoFilm) {
  const TemporaryFolder folder;
  EXPECT_THROW(Film(folder.path() / "a.avi", 25.0, kSize), InvalidRequest);
  EXPECT_THROW(Film(folder.path() / "a.mp4", 0.0, kSize), InvalidRequest);
  EXPECT_THROW(Film(folder.path() / "a.mp4", std::nan(""), kSize), InvalidRequest);
  EXPECT_THROW(Film(folder.path() / "a.mp4", 25.0, cv::Size(161, 120)), InvalidRequest);
  EXPECT_THROW(Film(folder.path() / "a.mp4", 25.0, cv::Size(0, 0)), InvalidRequest);
}

TEST(Film, RefusesAFrameOfAnotherSize) {
  const TemporaryFolder folder;
  Film film(folder.path() / "a.mp4", 25.0, kSize);
  EXPECT_THROW(film.add(cv::Mat(100, 100, CV_8UC3, cv::Scalar())), InvalidRequest);
}

TEST(Film, SaysThatItCannotBeBegunAndPrintsNothing) {
  const TemporaryFolder folder;
  testing::internal::CaptureStderr();
  EXPECT_THROW(Film(folder.path() / "nowhere" / "a.mp4", 25.0, kSize), SampleError);
  EXPECT_THROW(Film(folder.path() / "a.mp4", 25.0, cv::Size(1'000'000, 1'000'000)), SampleError);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace biotomy::reconstruct
