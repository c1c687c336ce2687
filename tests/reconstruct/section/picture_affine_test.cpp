#include "reconstruct/section/picture_affine.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "reconstruct/section/section.hpp"
#include "tests/reconstruct/bricks/memory_source.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::MemorySource;
using tests::noise;

TEST(PictureAffine, GoesForthAndBackAgain) {
  const Cuboid cuboid{{10'000, 5000, 5000}, {20.0, 20.0, 25.0}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int round = 0; round < 500; ++round) {
    const Plane plane =
        Plane::from_normal({any(random), any(random), any(random)}, 0.5 * cuboid.extent());
    const auto kind = round % 2 == 0 ? BasisKind::layer : BasisKind::xz;
    const PixelGrid grid =
        outline_section(cuboid, 8, {plane, section_basis(kind, plane), SectionStyle{}}).grid;
    const PictureAffine affine = picture_affine(grid, plane, 17, 4);
    const double u = grid.columns * (any(random) + 1.0) / 2.0;
    const double v = grid.rows * (any(random) + 1.0) / 2.0;
    const PicturePosition back = affine.picture_at(affine.sample_at(u, v));
    EXPECT_NEAR(back.u, u, 1e-9);
    EXPECT_NEAR(back.v, v, 1e-9);
    EXPECT_NEAR(back.distance, 0.0, 1e-9);
  }
}

TEST(PictureAffine, TellsTheDistanceFromThePlane) {
  const Cuboid cuboid{{100, 100, 100}, {10.0, 10.0, 10.0}};
  const Plane plane = Plane::from_normal({1, 2, 3}, {400, 400, 400});
  const PixelGrid grid =
      outline_section(cuboid, 8, {plane, section_basis(BasisKind::layer, plane), SectionStyle{}})
          .grid;
  const PictureAffine affine = picture_affine(grid, plane);
  const Vector3 beside = affine.sample_at(12.0, 7.0) + 5.5 * plane.normal();
  const PicturePosition position = affine.picture_at(beside);
  EXPECT_NEAR(position.u, 12.0, 1e-9);
  EXPECT_NEAR(position.v, 7.0, 1e-9);
  EXPECT_NEAR(position.distance, 5.5, 1e-9);
}

TEST(PictureAffine, BeginsAtThePixelThatABorderLeavesForTheSection) {
  const PixelGrid grid{{{1, 2, 3}, {{1, 0, 0}, {0, 1, 0}}, 100.0, 100.0}, 10.0, 11, 11};
  const PictureAffine affine = picture_affine(grid, Plane::from_normal({0, 0, 1}, {1, 2, 3}), 5, 7);
  EXPECT_EQ(affine.sample_at(5, 7), (Vector3{1, 2, 3}));
  EXPECT_EQ(affine.sample_at(6, 9), (Vector3{11, 22, 3}));
}

// The matrices are read here as a stranger would: a voxel in the plane is at the pixel that they
// name, and has its colour there.
TEST(PictureAffine, NamesThePixelThatHasAVoxelsColour) {
  MemorySource source;
  source.box.spacing = {10.0, 6.0, 8.0};
  source.voxel = noise(source.box.size, 255, 1);
  // Along the diagonals of the voxels, which are 10 um long: every second pixel is a voxel.
  const Plane plane = Plane::from_normal({0, 8, -6}, {0, 30, 0});
  SectionStyle style;
  style.pixel = 5.0;
  const Section section =
      cut_section(source, {plane, section_basis(BasisKind::layer, plane), style});
  const PictureAffine affine = picture_affine(section.outline.grid, plane);
  int found = 0;
  for (int z = 0; z < 20; ++z) {
    for (int x = 0; x < 40; ++x) {
      const int y = z + 5;
      const PicturePosition place = affine.picture_at({10.0 * x, 6.0 * y, 8.0 * z});
      ASSERT_NEAR(place.distance, 0.0, 1e-9);
      const int u = static_cast<int>(std::lround(place.u));
      const int v = static_cast<int>(std::lround(place.v));
      const cv::Vec3b colour = section.image.at<cv::Vec3b>(v, u);
      for (int c = 0; c < 3; ++c) {
        ASSERT_EQ(colour[c], source.voxel(x, y, z, c)) << x << ' ' << z;
      }
      ++found;
    }
  }
  EXPECT_EQ(found, 800);
}

}  // namespace
}  // namespace biotomy::reconstruct
