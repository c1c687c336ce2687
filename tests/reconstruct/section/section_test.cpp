#include "reconstruct/section/section.hpp"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/bricks/memory_source.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::MemorySource;
using tests::noise;

SectionRequest request_for(const Plane& plane, BasisKind kind = BasisKind::layer) {
  return {plane, section_basis(kind, plane), {}};
}

TEST(Section, IsTheSamePictureWhateverTheOrderOfThePoints) {
  MemorySource source;
  source.voxel = noise(source.box.size, 255, 1);
  std::array<Vector3, 3> points{Vector3{3.1, 250.7, 12.3}, Vector3{313.3, 8.9, 60.01},
                                Vector3{201.7, 202.2, 155.5}};
  for (const BasisKind kind : {BasisKind::layer, BasisKind::xz}) {
    const cv::Mat first =
        cut_section(source,
                    request_for(Plane::through_points(points[0], points[1], points[2]), kind))
            .image;
    std::array<int, 3> order{0, 1, 2};
    while (std::next_permutation(order.begin(), order.end())) {
      const Plane plane =
          Plane::through_points(points[order[0]], points[order[1]], points[order[2]]);
      const cv::Mat other = cut_section(source, request_for(plane, kind)).image;
      ASSERT_EQ(other.size(), first.size());
      EXPECT_EQ(cv::norm(other, first, cv::NORM_INF), 0.0);
    }
  }
}

TEST(Section, IsTheSamePictureWhateverTheSignOfTheNormal) {
  MemorySource source;
  source.voxel = noise(source.box.size, 255, 2);
  const cv::Mat one =
      cut_section(source, request_for(Plane::from_normal({1, 2, -3}, {200, 140, 90}))).image;
  const cv::Mat other =
      cut_section(source, request_for(Plane::from_normal({-1, -2, 3}, {200, 140, 90}))).image;
  ASSERT_EQ(one.size(), other.size());
  EXPECT_EQ(cv::norm(one, other, cv::NORM_INF), 0.0);
}

TEST(Section, HasPixelsOfTheLeastSpacingUnlessAskedOtherwise) {
  MemorySource source;
  source.box = {{40, 30, 20}, {10.0, 12.0, 5.0}};
  SectionRequest request = request_for(Plane::from_normal({0, 0, 1}, {0, 0, 40}));
  EXPECT_EQ(outline_section(source.box, 8, request).grid.pixel, 5.0);
  EXPECT_EQ(outline_section(source.box, 8, request).grid.columns, 79);
  request.style.pixel = 20.0;
  EXPECT_EQ(outline_section(source.box, 8, request).grid.columns, 20);
}

TEST(Section, IsBackgroundOutsideThePolygon) {
  MemorySource source;
  source.voxel = [](int, int, int, int) { return 100; };
  SectionRequest request = request_for(Plane::from_normal({1, 1, 1}, {100, 0, 0}));
  request.style.background = {1, 2, 3};
  const Section section = cut_section(source, request);
  ASSERT_EQ(section.outline.polygon.size(), 3U);
  const cv::Vec3b background{1, 2, 3};
  const cv::Vec3b tissue{100, 100, 100};
  const int last = section.image.rows - 1;
  EXPECT_EQ(section.image.at<cv::Vec3b>(last, 0), background);
  EXPECT_EQ(section.image.at<cv::Vec3b>(1, section.image.cols / 2), tissue);
  for (int row = 0; row < section.image.rows; ++row) {
    for (int column = 0; column < section.image.cols; ++column) {
      const auto& pixel = section.image.at<cv::Vec3b>(row, column);
      ASSERT_TRUE(pixel == background || pixel == tissue);
    }
  }
}

TEST(Section, BackgroundOf16BitsIsAsBright) {
  MemorySource source;
  source.bit_count = 16;
  SectionRequest request = request_for(Plane::from_normal({1, 1, 1}, {100, 0, 0}));
  request.style.background = {255, 1, 0};
  const Section section = cut_section(source, request);
  EXPECT_EQ(section.image.at<cv::Vec3w>(section.image.rows - 1, 0), cv::Vec3w(65535, 257, 0));
}

TEST(Section, OfAPlaneThatMissesIsAnError) {
  MemorySource source;
  EXPECT_THROW(cut_section(source, request_for(Plane::from_normal({0, 0, 1}, {0, 0, -1}))),
               SampleError);
}

TEST(Section, LargerThanAllowedIsRefusedBeforeAnythingIsRead) {
  MemorySource source;
  SectionRequest request = request_for(Plane::from_normal({0, 0, 1}, {0, 0, 10}));
  request.style.pixel = 1e-4;
  EXPECT_THROW(cut_section(source, request), SampleError);
  EXPECT_TRUE(source.asked.empty());
}

}  // namespace
}  // namespace biotomy::reconstruct
