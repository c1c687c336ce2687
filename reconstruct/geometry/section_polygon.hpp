#pragma once

#include <vector>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/geometry/plane.hpp"

namespace biotomy::reconstruct {

/// What a plane and the closed box of a sample have in common.
/// A corner nearer to the plane than 10⁻¹³ of the box's diagonal is on it; points nearer to each
/// other than 10⁻¹¹ of it are one point.
struct PlaneContact {
  /// None when the plane misses the box, one or two when it only touches a vertex or an edge, three
  /// to six when it cuts the box: a convex polygon. In micrometres. The polygon starts at the
  /// vertex least by x, then y, then z, and turns so that its order depends on the plane alone,
  /// not on the sign of its normal; edge I of the polygon goes from vertex I to the next.
  std::vector<Vector3> vertices;
  double distance = 0.0;  ///< between plane and box when it misses, micrometres
};

PlaneContact contact(const Plane& plane, const Cuboid& cuboid);

/// The polygon's 3 to 6 vertices, as PlaneContact has them. A plane along a face of the box cuts
/// it. Throws SampleError when the plane misses the box (saying by how much) or only touches it.
std::vector<Vector3> section_polygon(const Plane& plane, const Cuboid& cuboid);

}  // namespace biotomy::reconstruct
