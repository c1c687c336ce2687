#include "reconstruct/section/series_layout.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/section_polygon.hpp"
#include "reconstruct/section/picture_affine.hpp"

namespace biotomy::reconstruct {
namespace {

const Cuboid kCuboid{{41, 32, 23}, {10.0, 11.3, 17.9}};

Rotation about(const Vector3& axis) {
  Rotation rotation;
  rotation.axis = axis;
  rotation.to = 357.0;
  rotation.step = 3.0;
  return rotation;
}

PicturePosition on_canvas(const SeriesLayout& layout, const Series& series, std::size_t i,
                          const Vector3& position) {
  const cv::Point& place = layout.places[i];
  return picture_affine(layout.outlines[i]->grid, series.frames[i].plane, place.x, place.y)
      .picture_at(position);
}

SectionStyle style_of(const ThetaChoice& theta) {
  SectionStyle style;
  style.theta = theta;
  style.pixel = 7.7;
  return style;
}

double from_whole(double number) {
  return std::abs(number - std::round(number));
}

TEST(SeriesLayout, LeavesTheAxisThroughTheMiddleAtRest) {
  for (const ThetaChoice& theta :
       {ThetaChoice(theta::Bounding{}), ThetaChoice(theta::Inscribed{})}) {
    for (const Vector3& axis : {Vector3{1, 0, 0}, Vector3{0, 0, 1}, Vector3{1, 2, 3}}) {
      const Series series = rotation_series(about(axis), BasisKind::layer, kCuboid);
      const SeriesLayout layout = series_layout(kCuboid, 8, series, style_of(theta));
      for (const double along : {0.0, 100.0}) {
        const Vector3 point = 0.5 * kCuboid.extent() + (along / norm(axis)) * axis;
        const PicturePosition first = on_canvas(layout, series, 0, point);
        for (std::size_t i = 0; i < series.frames.size(); ++i) {
          const PicturePosition place = on_canvas(layout, series, i, point);
          EXPECT_NEAR(place.u, first.u, 1e-6) << i;
          EXPECT_NEAR(place.v, first.v, 1e-6) << i;
        }
      }
    }
  }
}

TEST(SeriesLayout, KeepsAPointThatMovesWithThePlaneOnThePartOfItsPixel) {
  Translation translation;
  translation.normal = {1, 2, 3};
  translation.step = 7.0;
  const Series series = translation_series(translation, BasisKind::layer, kCuboid);
  const SeriesLayout layout = series_layout(kCuboid, 8, series, style_of(theta::Bounding{}));
  const auto first = std::find_if(layout.outlines.begin(), layout.outlines.end(),
                                  [](const auto& outline) { return outline.has_value(); });
  ASSERT_NE(first, layout.outlines.end());
  const auto number = static_cast<std::size_t>(first - layout.outlines.begin());
  const PicturePosition rest = on_canvas(layout, series, number, series.frames[number].reference);
  for (std::size_t i = 0; i < series.frames.size(); ++i) {
    if (!layout.outlines[i] || layout.outlines[i]->grid.rectangle.width < 7.7 ||
        layout.outlines[i]->grid.rectangle.height < 7.7) {
      continue;
    }
    const PicturePosition place = on_canvas(layout, series, i, series.frames[i].reference);
    EXPECT_LT(from_whole(place.u - rest.u), 1e-6) << i;
    EXPECT_LT(from_whole(place.v - rest.v), 1e-6) << i;
  }
}

TEST(SeriesLayout, CentresTheSectionsToWithinAPixel) {
  for (const Vector3& normal : {Vector3{1, 2, 3}, Vector3{0, 1, 1}}) {
    Translation translation;
    translation.normal = normal;
    translation.step = 7.0;
    const Series series = translation_series(translation, BasisKind::layer, kCuboid);
    const SeriesLayout layout = series_layout(kCuboid, 8, series, style_of(theta::Bounding{}));
    for (std::size_t i = 0; i < series.frames.size(); ++i) {
      if (const auto& outline = layout.outlines[i]) {
        const cv::Point& place = layout.places[i];
        const double right = layout.size.width - place.x - outline->grid.columns;
        const double below = layout.size.height - place.y - outline->grid.rows;
        EXPECT_GE(std::min({double(place.x), double(place.y), right, below}), 0.0);
        EXPECT_LE(std::abs(place.x - right) / 2.0, 1.0) << i;
        EXPECT_LE(std::abs(place.y - below) / 2.0, 1.0) << i;
      }
    }
  }
}

TEST(SeriesLayout, HasNoSectionWhereThereIsNoSuchEdge) {
  Translation translation;
  translation.normal = {1, 1, 1};
  translation.step = 7.0;
  const Series series = translation_series(translation, BasisKind::layer, kCuboid);
  const SeriesLayout layout =
      series_layout(kCuboid, 8, series, style_of(theta::InscribedAtEdge{4}));
  int sections = 0;
  for (std::size_t i = 0; i < series.frames.size(); ++i) {
    const bool has_edge = contact(series.frames[i].plane, kCuboid).vertices.size() > 4;
    EXPECT_EQ(layout.outlines[i].has_value(), has_edge) << i;
    sections += has_edge ? 1 : 0;
  }
  EXPECT_GT(sections, 0);
  EXPECT_LT(sections, static_cast<int>(series.frames.size()));
  EXPECT_THROW(series_layout(kCuboid, 8, series, style_of(theta::InscribedAtEdge{6})),
               InvalidRequest);
}

TEST(SeriesLayout, LeavesACustomRectangleWhereItWasAskedFor) {
  const theta::Custom custom{{33.3, 44.4, 55.5}, 200.0, 100.0, 0.0};
  const Series series = rotation_series(about({1, 0, 0}), BasisKind::layer, kCuboid);
  const SeriesLayout layout = series_layout(kCuboid, 8, series, style_of(custom));
  for (std::size_t i = 0; i < series.frames.size(); ++i) {
    const Plane& plane = series.frames[i].plane;
    const Vector3 corner = custom.corner - plane.signed_distance(custom.corner) * plane.normal();
    EXPECT_LT(norm(layout.outlines[i]->grid.rectangle.origin - corner), 1e-9);
    EXPECT_EQ(layout.places[i], cv::Point(0, 0));
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
