#include "reconstruct/section/frame_canvas.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr Colour kBackground{96, 112, 136};
const cv::Vec3b kBackgroundPixel{96, 112, 136};

TEST(FrameCanvas, HasEvenSidesThatHoldThePictureAndItsLabel) {
  for (const cv::Size size : {cv::Size(301, 201), cv::Size(300, 200), cv::Size(5, 1)}) {
    const FrameCanvas canvas(size, "+180.0 deg", kBackground);
    EXPECT_EQ(canvas.size().width % 2, 0);
    EXPECT_EQ(canvas.size().height % 2, 0);
    EXPECT_GE(canvas.size().width, size.width);
    EXPECT_GT(canvas.size().height, size.height);
  }
}

TEST(FrameCanvas, PutsThePictureInTheMiddleUntouched) {
  const FrameCanvas canvas({300, 200}, "+180.0 deg", kBackground);
  cv::Mat picture(100, 150, CV_8UC3);
  cv::RNG random(1);
  random.fill(picture, cv::RNG::UNIFORM, 0, 256);
  cv::Mat frame = canvas.draw_empty(CV_8UC3, "+000.0 deg");
  picture.copyTo(canvas.part_for({canvas.place_of(picture.size()), picture.size()}, frame));
  ASSERT_EQ(frame.size(), canvas.size());
  EXPECT_EQ(cv::norm(frame(cv::Rect(75, 50, 150, 100)), picture, cv::NORM_INF), 0.0);
  EXPECT_EQ(frame.at<cv::Vec3b>(0, 0), kBackgroundPixel);
  EXPECT_EQ(frame.at<cv::Vec3b>(50, 74), kBackgroundPixel);
}

TEST(FrameCanvas, DrawsTheLabelBelowThePicture) {
  for (const int type : {CV_8UC3, CV_16UC3}) {
    const FrameCanvas canvas({300, 200}, "+180.0 deg", kBackground);
    const cv::Mat zero = canvas.draw_empty(type, "+000.0 deg");
    const cv::Mat turned = canvas.draw_empty(type, "+012.0 deg");
    EXPECT_EQ(zero.type(), type);
    cv::Mat different;
    cv::absdiff(zero, turned, different);
    EXPECT_GT(cv::norm(different, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::norm(different.rowRange(0, 200), cv::NORM_INF), 0.0);
  }
}

TEST(FrameCanvas, WritesWhiteOnDarkAndBlackOnLight) {
  for (const bool light : {false, true}) {
    const Colour background = light ? Colour{255, 255, 255} : Colour{0, 0, 0};
    const cv::Mat frame = FrameCanvas({400, 100}, "", background, ScaleBar{200.0, 57, "200 um"})
                              .draw_empty(CV_8UC3, "");
    const cv::Scalar paper(background[0], background[1], background[2]);
    const cv::Mat apart = cv::abs(frame - cv::Mat(frame.size(), CV_8UC3, paper));
    EXPECT_EQ(cv::norm(apart, cv::NORM_INF), 255.0);
  }
}

TEST(FrameCanvas, DrawsTheScaleBarOnTheRightInItsLength) {
  const ScaleBar bar{200.0, 57, "200 um"};
  for (const int type : {CV_8UC3, CV_16UC3}) {
    const FrameCanvas canvas({400, 100}, "+180.0 deg", kBackground, bar);
    const cv::Mat frame = canvas.draw_empty(type, "+000.0 deg");
    cv::Mat eight_bits;
    frame.convertTo(eight_bits, CV_8U, type == CV_8UC3 ? 1.0 : 1.0 / 257.0);
    int longest = 0;
    for (int y = 100; y < frame.rows; ++y) {
      int run = 0;
      for (int x = 200; x < frame.cols; ++x) {
        run = eight_bits.at<cv::Vec3b>(y, x) == cv::Vec3b(255, 255, 255) ? run + 1 : 0;
        longest = std::max(longest, run);
      }
    }
    EXPECT_EQ(longest, 57);
  }
}

TEST(FrameCanvas, DrawsTheScaleBarToLessThanAPixel) {
  constexpr double kInk = 255.0 - kBackground[0];
  const auto ink_of = [](double pixels) {
    const FrameCanvas canvas({40, 10}, "", kBackground, ScaleBar{200.0, pixels, "200 um"});
    const cv::Mat frame = canvas.draw_empty(CV_8UC3, "");
    return (cv::sum(frame)[0] - static_cast<double>(frame.total()) * kBackground[0]) / kInk;
  };
  const double of_a_pixel = ink_of(2.0) - ink_of(1.0);
  EXPECT_EQ(of_a_pixel, std::round(of_a_pixel));  // the bar's thickness
  for (const double pixels : {0.5, 3.0, 7.25, 19.9}) {
    EXPECT_NEAR(ink_of(pixels) - ink_of(1.0), (pixels - 1.0) * of_a_pixel, 0.01 * of_a_pixel);
  }
}

TEST(FrameCanvas, IsWideEnoughForLabelAndScaleBar) {
  const ScaleBar bar{200.0, 20, "200 um"};
  const FrameCanvas with({10, 10}, "+180.0 deg", kBackground, bar);
  const FrameCanvas without({10, 10}, "+180.0 deg", kBackground);
  EXPECT_GT(with.size().width, without.size().width + 20);
  const cv::Mat left = with.draw_empty(CV_8UC3, "+180.0 deg").colRange(0, without.size().width - 8);
  EXPECT_EQ(cv::norm(left, without.draw_empty(CV_8UC3, "+180.0 deg").colRange(0, left.cols),
                     cv::NORM_INF),
            0.0);
}

TEST(FrameCanvas, KeepsNoRoomForWhatIsNotWanted) {
  const FrameCanvas bare({301, 201}, "", kBackground);
  EXPECT_EQ(bare.size(), cv::Size(302, 202));

  const ScaleBar bar{200.0, 20, "200 um"};
  const FrameCanvas bar_alone({10, 10}, "", kBackground, bar);
  const FrameCanvas both({10, 10}, "+180.0 deg", kBackground, bar);
  EXPECT_EQ(bar_alone.size().height, both.size().height);
  EXPECT_LT(bar_alone.size().width, both.size().width);
  const int right = bar_alone.size().width;
  EXPECT_EQ(
      cv::norm(bar_alone.draw_empty(CV_8UC3, ""),
               both.draw_empty(CV_8UC3, "").colRange(both.size().width - right, both.size().width),
               cv::NORM_INF),
      0.0);
}

TEST(FrameCanvas, TakesLittleMoreThanThePictureHoweverWideThatIs) {
  for (const int height : {10, 1000, 20'000}) {
    const FrameCanvas canvas({1'000'000, height}, "+180.0 deg", kBackground,
                             ScaleBar{2e5, 200'000, "200 mm"});
    EXPECT_LT(canvas.size().height, height + 40 + height / 4);
    EXPECT_EQ(canvas.bytes(CV_16UC3), 6.0 * canvas.size().height * 1e6);
  }
}

TEST(FrameCanvas, SaysWhereAPictureLies) {
  const FrameCanvas canvas({300, 200}, "+180.0 deg", kBackground);
  EXPECT_EQ(canvas.place_of({150, 100}), cv::Point(75, 50));
  EXPECT_EQ(canvas.place_of({300, 200}), cv::Point(0, 0));
}

TEST(FrameCanvas, RefusesAPictureLargerThanTheLargest) {
  const FrameCanvas canvas({300, 200}, "+180.0 deg", kBackground);
  EXPECT_THROW(canvas.place_of({300, 203}), InvalidRequest);
  cv::Mat frame = canvas.draw_empty(CV_8UC3, "");
  for (const cv::Rect& part :
       {cv::Rect(0, 0, 300, 203), cv::Rect(-1, 0, 300, 200), cv::Rect(0, 4, 300, 200)}) {
    EXPECT_THROW(canvas.part_for(part, frame), InvalidRequest);
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
