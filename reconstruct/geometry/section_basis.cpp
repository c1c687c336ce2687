#include "reconstruct/geometry/section_basis.hpp"

#include <cmath>

#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"

namespace biotomy::reconstruct {
namespace {

// The normal has length 1 and no component between 0 and 10⁻¹¹, so M = √(A²+B²)·1 and
// L = √(A²+C²)·1 are well away from zero wherever they are divided by.

SectionBasis layer_basis(const Vector3& normal) {
  const double across = std::hypot(normal.x, normal.y);
  if (across == 0.0) {
    return {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  }
  Vector3 p{-normal.y / across, normal.x / across, 0.0};
  if (p.x < 0.0 || (p.x == 0.0 && p.y < 0.0)) {
    p = -1.0 * p;
  }
  const Vector3 q{-normal.x * normal.z / across, -normal.y * normal.z / across, across};
  return {p, q};
}

SectionBasis xz_basis(const Vector3& normal) {
  const double across = std::hypot(normal.x, normal.z);
  if (across == 0.0) {
    return {{1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  }
  Vector3 xi{normal.z / across, 0.0, -normal.x / across};
  if (xi.x < 0.0 || (xi.x == 0.0 && xi.z < 0.0)) {
    xi = -1.0 * xi;
  }
  const Vector3 eta{-normal.x * normal.y / across, across, -normal.y * normal.z / across};
  return {xi, eta};
}

}  // namespace

BasisKind basis_kind(const std::string& name) {
  if (name == "layer") {
    return BasisKind::layer;
  }
  if (name == "xz") {
    return BasisKind::xz;
  }
  throw InvalidRequest("no basis is called '" + excerpt(name) + "': there are layer and xz");
}

SectionBasis section_basis(BasisKind kind, const Plane& plane) {
  return kind == BasisKind::layer ? layer_basis(plane.normal()) : xz_basis(plane.normal());
}

}  // namespace biotomy::reconstruct
