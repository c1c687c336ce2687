#include "reconstruct/section/series.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/section/picture_affine.hpp"
#include "reconstruct/section/section.hpp"

namespace biotomy::reconstruct {
namespace {

const Cuboid kCuboid{{41, 31, 21}, {10.0, 10.0, 10.0}};  // extent 400 × 300 × 200

Rotation about(const Vector3& axis) {
  Rotation rotation;
  rotation.axis = axis;
  rotation.to = 360.0;
  rotation.step = 7.5;
  return rotation;
}

void expect_near(const Vector3& a, const Vector3& b, double tolerance) {
  EXPECT_NEAR(norm(a - b), 0.0, tolerance) << a.x << ',' << a.y << ',' << a.z;
}

TEST(RotationSeries, HasAFrameAtBothEnds) {
  Rotation rotation = about({0, 0, 1});
  rotation.from = 0.0;
  rotation.to = 0.3;
  rotation.step = 0.1;
  const Series series = rotation_series(rotation, BasisKind::layer, kCuboid);
  ASSERT_EQ(series.frames.size(), 4U);
  EXPECT_EQ(series.frames.front().value, 0.0);
  EXPECT_NEAR(series.frames.back().value, 0.3, 1e-15);
}

TEST(RotationSeries, GoesBackwardsWithANegativeStep) {
  Rotation rotation = about({0, 0, 1});
  rotation.from = 90.0;
  rotation.to = -90.0;
  rotation.step = -45.0;
  EXPECT_EQ(rotation_series(rotation, BasisKind::layer, kCuboid).frames.size(), 5U);
}

TEST(RotationSeries, RefusesStepsThatLeadNowhere) {
  Rotation rotation = about({0, 0, 1});
  for (const double step : {0.0, -1.0, 1e-9, std::nan("")}) {
    rotation.step = step;
    EXPECT_THROW(rotation_series(rotation, BasisKind::layer, kCuboid), InvalidRequest) << step;
  }
}

TEST(RotationSeries, RefusesAnAxisWithoutDirection) {
  EXPECT_THROW(rotation_series(about({0, 0, 0}), BasisKind::layer, kCuboid), InvalidRequest);
}

TEST(RotationSeries, BeginsAlongALayerUnlessTheAxisIsAcrossThem) {
  const auto first_normal = [](const Vector3& axis) {
    return rotation_series(about(axis), BasisKind::layer, kCuboid).frames[0].plane.normal();
  };
  expect_near(first_normal({1, 0, 0}), {0, 0, 1}, 1e-15);
  expect_near(first_normal({0, 1, 0}), {0, 0, 1}, 1e-15);
  expect_near(first_normal({0, 0, 1}), {0, 1, 0}, 1e-15);
}

TEST(RotationSeries, TurnsByTheRightHand) {
  Rotation rotation = about({1, 0, 0});
  rotation.step = 90.0;
  const Series series = rotation_series(rotation, BasisKind::layer, kCuboid);
  ASSERT_EQ(series.frames.size(), 5U);
  EXPECT_EQ(series.frames[1].plane.normal(), (Vector3{0, -1, 0}));
  EXPECT_EQ(series.frames[2].plane.normal(), (Vector3{0, 0, -1}));
  EXPECT_EQ(series.frames[4].plane.normal(), (Vector3{0, 0, 1}));
}

TEST(RotationSeries, AllPlanesHoldTheAxis) {
  Rotation rotation = about({1, 2, 2});
  rotation.through = Vector3{10, 20, 30};
  for (const SeriesFrame& frame : rotation_series(rotation, BasisKind::xz, kCuboid).frames) {
    EXPECT_NEAR(frame.plane.signed_distance({10, 20, 30}), 0.0, 1e-12);
    EXPECT_NEAR(frame.plane.signed_distance({11, 22, 32}), 0.0, 1e-12);
  }
}

// A basis made anew for each plane jumps where p_x passes zero and where the plane lies in a
// layer; over whole turns about these axes both happen.
TEST(RotationSeries, NeverFlipsFromOneFrameToTheNext) {
  for (const Vector3& axis :
       {Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}, Vector3{1, 1, 1}, Vector3{0, 1, 3}}) {
    for (const BasisKind kind : {BasisKind::layer, BasisKind::xz}) {
      const auto frames = rotation_series(about(axis), kind, kCuboid).frames;
      ASSERT_EQ(frames.size(), 49U);
      const double step = 2.0 * std::sin(3.75 * M_PI / 180.0);  // the chord of 7.5 degrees
      for (std::size_t i = 1; i < frames.size(); ++i) {
        EXPECT_LE(norm(frames[i].basis.p - frames[i - 1].basis.p), step + 1e-12);
        EXPECT_LE(norm(frames[i].basis.q - frames[i - 1].basis.q), step + 1e-12);
      }
    }
  }
}

// Over whole turns these planes pass through all that are degenerate for one basis or the other.
// The matrix from pixels to the sample may differ by the rotation alone: its first two columns are
// turned by the step, by whose chord they move, and its third is the corner of another rectangle.
TEST(RotationSeries, PixelsTurnWithThePlaneAndDoNothingElse) {
  for (const Vector3& axis :
       {Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}, Vector3{1, 2, -1}}) {
    for (const BasisKind kind : {BasisKind::layer, BasisKind::xz}) {
      Rotation rotation = about(axis);
      rotation.step = 5.0;
      const Vector3 unit = (1.0 / norm(axis)) * axis;
      const double cosine = std::cos(5.0 * M_PI / 180.0);
      const double sine = std::sin(5.0 * M_PI / 180.0);
      const auto turned = [&](const Vector3& v) {
        return cosine * v + sine * cross(unit, v) + ((1.0 - cosine) * dot(unit, v)) * unit;
      };
      std::vector<PictureAffine> affines;
      for (const SeriesFrame& frame : rotation_series(rotation, kind, kCuboid).frames) {
        const auto outline =
            outline_section(kCuboid, 8, {frame.plane, frame.basis, SectionStyle{}});
        affines.push_back(picture_affine(outline.grid, frame.plane));
      }
      ASSERT_EQ(affines.size(), 73U);
      for (std::size_t i = 1; i < affines.size(); ++i) {
        for (std::size_t column = 0; column < 2; ++column) {
          const auto direction = [&](const PictureAffine& affine) {
            const auto& m = affine.pixel_to_sample;
            return Vector3{m[0][column], m[1][column], m[2][column]};
          };
          expect_near(direction(affines[i]), turned(direction(affines[i - 1])), 1e-9);
        }
        // The axis stays where it is in the plane: pixels of its points differ by a shift alone.
        const Vector3 middle = 0.5 * kCuboid.extent();
        const PicturePosition one = affines[i].picture_at(middle + 30.0 * unit);
        const PicturePosition other = affines[i - 1].picture_at(middle + 30.0 * unit);
        const PicturePosition centre_one = affines[i].picture_at(middle);
        const PicturePosition centre_other = affines[i - 1].picture_at(middle);
        EXPECT_NEAR(one.u - centre_one.u, other.u - centre_other.u, 1e-9);
        EXPECT_NEAR(one.v - centre_one.v, other.v - centre_other.v, 1e-9);
        EXPECT_NEAR(one.distance, 0.0, 1e-9);
      }
    }
  }
}

TEST(RotationSeries, BasesStayOrthonormalAndInTheirPlanes) {
  for (const SeriesFrame& frame :
       rotation_series(about({1, 2, -1}), BasisKind::layer, kCuboid).frames) {
    EXPECT_NEAR(norm(frame.basis.p), 1.0, 1e-14);
    EXPECT_NEAR(norm(frame.basis.q), 1.0, 1e-14);
    EXPECT_NEAR(dot(frame.basis.p, frame.basis.q), 0.0, 1e-14);
    EXPECT_NEAR(dot(frame.basis.p, frame.plane.normal()), 0.0, 1e-14);
    EXPECT_NEAR(dot(frame.basis.q, frame.plane.normal()), 0.0, 1e-14);
  }
}

TEST(TranslationSeries, GoesThroughTheWholeSampleUnlessAskedOtherwise) {
  Translation translation;
  translation.normal = {0, 0, 5};
  translation.step = 10.0;
  const Series series = translation_series(translation, BasisKind::layer, kCuboid);
  ASSERT_EQ(series.frames.size(), 21U);
  EXPECT_EQ(series.frames.front().value, 0.0);
  EXPECT_EQ(series.frames.back().value, 200.0);
  EXPECT_EQ(series.frames[7].plane.offset(), -70.0);

  translation.normal = {0, 0, -1};
  EXPECT_EQ(translation_series(translation, BasisKind::layer, kCuboid).frames.front().value,
            -200.0);
}

TEST(TranslationSeries, OffsetsAreFromThePointAskedFor) {
  Translation translation;
  translation.normal = {1, 0, 0};
  translation.through = Vector3{100, 7, 7};
  translation.from = -20.0;
  translation.to = 20.0;
  translation.step = 20.0;
  const Series series = translation_series(translation, BasisKind::layer, kCuboid);
  ASSERT_EQ(series.frames.size(), 3U);
  EXPECT_DOUBLE_EQ(series.frames[0].plane.offset(), -80.0);
  EXPECT_DOUBLE_EQ(series.frames[2].plane.offset(), -120.0);
}

TEST(TranslationSeries, AllFramesShareOneBasis) {
  Translation translation;
  translation.normal = {1, -2, 0.5};
  translation.step = 20.0;
  const Series series = translation_series(translation, BasisKind::layer, kCuboid);
  for (const SeriesFrame& frame : series.frames) {
    EXPECT_EQ(frame.basis.p, series.frames[0].basis.p);
    EXPECT_EQ(frame.basis.q, series.frames[0].basis.q);
  }
}

TEST(FrameLabel, SaysTheAngleWithItsSign) {
  Rotation rotation = about({0, 0, 1});
  rotation.from = -12.0;
  rotation.to = 12.0;
  rotation.step = 12.0;
  const Series series = rotation_series(rotation, BasisKind::layer, kCuboid);
  EXPECT_EQ(frame_label(series, 0), "-012.0 deg");
  EXPECT_EQ(frame_label(series, 1), "+000.0 deg");
  EXPECT_EQ(frame_label(series, 2), "+012.0 deg");
  EXPECT_EQ(frame_file_name(series, 2), "002_+012.0deg.png");
  EXPECT_EQ(frame_file_name(series, 0, ".tif"), "000_-012.0deg.tif");
}

TEST(FrameLabel, HasAsManyDecimalsAsTheStepNeeds) {
  Rotation rotation = about({0, 0, 1});
  rotation.to = 1.0;
  rotation.step = 0.125;
  const Series series = rotation_series(rotation, BasisKind::layer, kCuboid);
  EXPECT_EQ(frame_label(series, 1), "+000.125 deg");
}

TEST(FrameLabel, IsNeverMinusZero) {
  Rotation rotation = about({0, 0, 1});
  rotation.from = -0.3;
  rotation.to = 0.3;
  rotation.step = 0.1;
  const Series series = rotation_series(rotation, BasisKind::layer, kCuboid);
  ASSERT_EQ(series.frames.size(), 7U);
  EXPECT_EQ(frame_label(series, 3), "+000.0 deg");
}

TEST(FrameFileName, SortsInTheOrderOfTheFrames) {
  Translation translation;
  translation.normal = {0, 0, 1};
  translation.from = 1500.0;
  translation.to = -1500.0;
  translation.step = -2.0;
  const Series series = translation_series(translation, BasisKind::layer, kCuboid);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < series.frames.size(); ++i) {
    names.push_back(frame_file_name(series, i));
  }
  EXPECT_EQ(names.front(), "0000_+1500.0um.png");
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
}

}  // namespace
}  // namespace biotomy::reconstruct
