#include "reconstruct/section/series_frames.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/bricks/memory_source.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::MemorySource;
using tests::noise;

SectionStyle grey_blue_style() {
  SectionStyle style;
  style.background = kGreyBlue;
  return style;
}

Translation along_z() {
  Translation translation;
  translation.normal = {0, 0, 1};
  translation.step = 10.0;
  return translation;
}

TEST(SeriesFrames, AreAllOfOneSize) {
  MemorySource source;
  Rotation rotation;
  rotation.axis = {1, 0, 0};
  rotation.to = 90.0;
  rotation.step = 30.0;
  const SeriesFrames frames(source, rotation_series(rotation, BasisKind::layer, source.box),
                            grey_blue_style());
  ASSERT_EQ(frames.count(), 4U);
  for (std::size_t i = 0; i < frames.count(); ++i) {
    EXPECT_EQ(frames.draw(i).image.size(), frames.frame_size());
  }
}

TEST(SeriesFrames, ShowTheLayersInASeriesAlongZ) {
  MemorySource source;
  source.voxel = noise(source.box.size, 255, 1);
  const SeriesFrames frames(source, translation_series(along_z(), BasisKind::layer, source.box),
                            grey_blue_style());
  ASSERT_EQ(frames.count(), 20U);
  const cv::Mat frame = frames.draw(13).image;
  const int left = (frames.frame_size().width - 40) / 2;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      ASSERT_EQ(frame.at<cv::Vec3b>(y, left + x)[1], source.voxel(x, y, 13, 1));
    }
  }
}

TEST(SeriesFrames, AreBackgroundWhereThePlaneMisses) {
  MemorySource source;
  source.voxel = [](int, int, int, int) { return 255; };
  Translation translation = along_z();
  translation.from = 0.0;
  translation.to = 400.0;
  translation.step = 200.0;
  const SeriesFrames frames(source, translation_series(translation, BasisKind::layer, source.box),
                            grey_blue_style());
  const cv::Mat empty = frames.draw(2).image;
  const cv::Vec3b background(kGreyBlue[0], kGreyBlue[1], kGreyBlue[2]);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < empty.cols; ++x) {
      ASSERT_EQ(empty.at<cv::Vec3b>(y, x), background);
    }
  }
  EXPECT_EQ(empty.size(), frames.draw(0).image.size());
}

TEST(SeriesFrames, HaveAScaleBarUnlessItIsNotWanted) {
  MemorySource source;
  const Series series = translation_series(along_z(), BasisKind::layer, source.box);
  const SeriesFrames with(source, series, grey_blue_style());
  const SeriesFrames without(source, series, grey_blue_style(), {.scale_bar = false});
  EXPECT_GT(with.frame_size().width, without.frame_size().width);  // the sample is a small one
}

TEST(SeriesFrames, AreTheSectionsAloneWithoutMarks) {
  MemorySource source;
  source.voxel = noise(source.box.size, 255, 1);
  const SeriesFrames frames(source, translation_series(along_z(), BasisKind::layer, source.box),
                            grey_blue_style(), {.label = false, .scale_bar = false});
  ASSERT_EQ(frames.frame_size(), cv::Size(40, 30));
  const cv::Mat frame = frames.draw(13).image;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      ASSERT_EQ(frame.at<cv::Vec3b>(y, x)[1], source.voxel(x, y, 13, 1));
    }
  }
}

TEST(SeriesFrames, SayWhereTheirSectionLies) {
  MemorySource source;
  source.voxel = noise(source.box.size, 255, 1);
  Translation translation = along_z();
  translation.from = 0.0;
  translation.to = 400.0;
  translation.step = 200.0;
  const SeriesFrames frames(source, translation_series(translation, BasisKind::layer, source.box),
                            grey_blue_style());
  ASSERT_TRUE(frames.outline(0).has_value());
  EXPECT_EQ(frames.outline(0)->grid.columns, 40);
  const cv::Mat frame = frames.draw(0).image;
  const cv::Point first = frames.first_pixel(0);
  EXPECT_EQ(frame.at<cv::Vec3b>(first)[0], source.voxel(0, 0, 0, 0));
  EXPECT_EQ(frame.at<cv::Vec3b>(first + cv::Point(39, 29))[2], source.voxel(39, 29, 0, 2));
  EXPECT_FALSE(frames.outline(2).has_value());
}

TEST(SeriesFrames, RefuseASeriesThatMissesTheSampleAltogether) {
  MemorySource source;
  Translation translation = along_z();
  translation.from = 1000.0;
  translation.to = 2000.0;
  EXPECT_THROW(SeriesFrames(source, translation_series(translation, BasisKind::layer, source.box),
                            grey_blue_style()),
               SampleError);
}

TEST(SeriesFrames, RefuseFramesThatAreTooLargeBeforeAnythingIsRead) {
  MemorySource source;
  SectionStyle style = grey_blue_style();
  style.pixel = 1e-3;
  EXPECT_THROW(
      SeriesFrames(source, translation_series(along_z(), BasisKind::layer, source.box), style),
      SampleError);
  EXPECT_TRUE(source.asked.empty());
}

}  // namespace
}  // namespace biotomy::reconstruct
