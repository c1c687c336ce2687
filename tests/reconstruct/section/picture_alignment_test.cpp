#include "reconstruct/section/picture_alignment.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

constexpr double kPixel = 10.0;

/// A rectangle of so many micrometres with its corner at `origin`, and its reference.
PictureInSequence picture(const Vector3& origin, double width, double height,
                          const Vector3& reference) {
  const ThetaRectangle rectangle{origin, {{1, 0, 0}, {0, 1, 0}}, width, height};
  return {pixel_grid(rectangle, kPixel, 3, 1'000'000'000), reference};
}

/// Of the reference, among the pixels of all.
std::array<double, 2> place(const AlignedPicture& aligned, const Vector3& reference) {
  const Vector3& origin = aligned.grid.rectangle.origin;
  return {aligned.first.x + (reference.x - origin.x) / kPixel,
          aligned.first.y + (reference.y - origin.y) / kPixel};
}

TEST(PictureAlignment, KeepsThePixelsOfTheFirst) {
  const AlignedPictures aligned =
      align_pictures(std::vector{picture({3, 4, 0}, 101, 57, {50, 30, 0})});
  EXPECT_EQ(aligned.pictures[0].grid.rectangle.origin, (Vector3{3, 4, 0}));
  EXPECT_EQ(aligned.pictures[0].first, cv::Point(0, 0));
  EXPECT_EQ(aligned.size, cv::Size(11, 6));
}

TEST(PictureAlignment, KeepsCentresWhereTheyAre) {
  std::vector<PictureInSequence> pictures;
  for (int i = 0; i < 100; ++i) {
    const double width = 400.0 - 3.7 * i;
    const double height = 100.0 + 2.3 * i;
    pictures.push_back(picture({-0.5 * width, -0.5 * height, 0}, width, height, {}));
  }
  const AlignedPictures aligned = align_pictures(pictures);
  const std::array<double, 2> first = place(aligned.pictures[0], {});
  for (const AlignedPicture& each : aligned.pictures) {
    EXPECT_NEAR(place(each, {})[0], first[0], 1e-9);
    EXPECT_NEAR(place(each, {})[1], first[1], 1e-9);
    EXPECT_GE(each.first.x, 0);
    EXPECT_GE(each.first.y, 0);
    EXPECT_LE(each.first.x + each.grid.columns, aligned.size.width);
    EXPECT_LE(each.first.y + each.grid.rows, aligned.size.height);
  }
  EXPECT_LE(aligned.size.width, 42);
  EXPECT_LE(aligned.size.height, 34);
}

TEST(PictureAlignment, KeepsAReferenceBesideTheCentreOnThePartOfItsPixel) {
  std::vector<PictureInSequence> pictures;
  for (int i = 0; i < 100; ++i) {
    pictures.push_back(picture({-2.0 * i, 1.3 * i, 0}, 200.0 + 3.1 * i, 150.0, {55, 66, 0}));
  }
  const AlignedPictures aligned = align_pictures(pictures);
  const Vector3 reference{55, 66, 0};
  const std::array<double, 2> first = place(aligned.pictures[0], reference);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    for (const std::size_t side : {0U, 1U}) {
      const double apart = place(aligned.pictures[i], reference)[side] - first[side];
      EXPECT_NEAR(apart, std::round(apart), 1e-9);
    }
    // The middle of the rectangle, against that of the first.
    const ThetaRectangle& whole = pictures[i].grid.rectangle;
    const Vector3 middle = whole.origin + Vector3{0.5 * whole.width, 0.5 * whole.height, 0};
    const Vector3 middle_of_first{100, 75, 0};
    for (const std::size_t side : {0U, 1U}) {
      EXPECT_NEAR(place(aligned.pictures[i], middle)[side],
                  place(aligned.pictures[0], middle_of_first)[side], 0.5 + 1e-5);
    }
  }
}

// Whichever way the coordinates' rounding goes.
TEST(PictureAlignment, DoesNotTrembleHalfWayBetweenTwoPixels) {
  std::vector<PictureInSequence> pictures{picture({0, 0, 0}, 200, 100, {0, 0, 0})};
  for (int i = 0; i < 20; ++i) {
    pictures.push_back(picture({0, 0, 0}, 210 + (i % 2 == 0 ? 1e-9 : -1e-9), 100, {0, 0, 0}));
  }
  const AlignedPictures aligned = align_pictures(pictures);
  for (std::size_t i = 2; i < pictures.size(); ++i) {
    EXPECT_EQ(aligned.pictures[i].first, aligned.pictures[1].first);
  }
}

TEST(PictureAlignment, KeepsAPixelOfEveryPicture) {
  const AlignedPictures aligned = align_pictures(
      std::vector{picture({0, 0, 0}, 200, 100, {0, 0, 0}), picture({1, 2, 0}, 3, 1, {0, 0, 0})});
  EXPECT_EQ(aligned.pictures[1].grid.columns, 1);
  EXPECT_EQ(aligned.pictures[1].grid.rows, 1);
  EXPECT_EQ(aligned.pictures[1].grid.rectangle.origin, (Vector3{1, 2, 0}));
}

}  // namespace
}  // namespace biotomy::reconstruct
