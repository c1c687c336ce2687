#pragma once

#include <cstddef>

#include "reconstruct/geometry/planar_polygon.hpp"

namespace biotomy::reconstruct {

/// A rectangle along axes that are turned by `angle` radians from the polygon's, from x towards y.
/// `corner` has its least coordinates along those axes; lengths are in micrometres.
struct PlanarRectangle {
  double angle = 0.0;
  PlanarPoint corner;
  double width = 0.0;
  double height = 0.0;
};

/// The three functions give the rectangle of the greatest area inside `polygon`, to within 10⁻¹⁴ of
/// the polygon's diameter (more only where the polygon is too thin for that, and 10⁻¹¹ at most).
/// Where such a rectangle can be moved, it is in the middle of where it can be. They throw
/// SampleError when the polygon is so thin that none can be found.

/// Along axes turned by `angle`. Exact to rounding. A polygon that is itself such a rectangle comes
/// back as it is.
PlanarRectangle largest_rectangle(const PlanarPolygon& polygon, double angle);

/// With a side on edge `edge`, which goes from vertex `edge` to the next one. Exact to rounding.
/// Its angle is within (−45°, 45°].
PlanarRectangle largest_rectangle_on_edge(const PlanarPolygon& polygon, std::size_t edge);

/// At any angle within (−45°, 45°], which are all that there are but for names of the sides. Of
/// angles whose areas differ by less than 10⁻¹⁰ it takes the least, and +θ before −θ; so its area
/// is the greatest to that much.
PlanarRectangle largest_rectangle_at_any_angle(const PlanarPolygon& polygon);

}  // namespace biotomy::reconstruct
