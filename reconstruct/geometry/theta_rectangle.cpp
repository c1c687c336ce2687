#include "reconstruct/geometry/theta_rectangle.hpp"

#include <algorithm>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

// Coordinates are taken from the first vertex, not from the sample's corner: where the rectangle
// starts at that vertex, as it does in a section along a layer, its origin is exact.
ThetaRectangle bounding_rectangle(std::span<const Vector3> polygon, const SectionBasis& basis) {
  const Vector3& reference = polygon.front();
  double least_p = 0.0;
  double most_p = 0.0;
  double least_q = 0.0;
  double most_q = 0.0;
  for (const Vector3& vertex : polygon) {
    const double p = dot(vertex - reference, basis.p);
    const double q = dot(vertex - reference, basis.q);
    least_p = std::min(least_p, p);
    most_p = std::max(most_p, p);
    least_q = std::min(least_q, q);
    most_q = std::max(most_q, q);
  }
  return {reference + least_p * basis.p + least_q * basis.q, basis, most_p - least_p,
          most_q - least_q};
}

}  // namespace

ThetaKind theta_kind(const std::string& name) {
  if (name == "bounding") {
    return ThetaKind::bounding;
  }
  throw InvalidRequest("theta-rectangle '" + name + "' is not there: there is bounding");
}

ThetaRectangle theta_rectangle(ThetaKind kind, std::span<const Vector3> polygon,
                               const SectionBasis& basis) {
  switch (kind) {
    case ThetaKind::bounding:
      return bounding_rectangle(polygon, basis);
  }
  throw InvalidRequest("this theta-rectangle is not known");
}

}  // namespace biotomy::reconstruct
