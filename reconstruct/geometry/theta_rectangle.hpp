#pragma once

#include <span>
#include <variant>

#include "reconstruct/geometry/section_basis.hpp"
#include "reconstruct/geometry/vector3.hpp"

namespace biotomy::reconstruct {

/// The rectangle of the section plane that becomes the picture. `origin` is its first corner, the
/// centre of pixel (0, 0), with its least coordinates along both axes; width goes along p and
/// height along q, both in micrometres.
struct ThetaRectangle {
  Vector3 origin;
  SectionBasis axes;
  double width = 0.0;
  double height = 0.0;
};

/// How the rectangle is chosen for a section polygon.
namespace theta {

/// The smallest one along the basis that holds the polygon.
struct Bounding {
  friend bool operator==(const Bounding&, const Bounding&) = default;
};

/// The one of the greatest area along the basis inside the polygon.
struct Inscribed {
  friend bool operator==(const Inscribed&, const Inscribed&) = default;
};

/// The one of the greatest area inside the polygon, to 10⁻¹⁰ of it. The axes are the basis, turned
/// by an angle within (−45°, 45°]; of equal rectangles it is the one turned the least, and from p
/// towards q rather than back.
struct InscribedAny {
  friend bool operator==(const InscribedAny&, const InscribedAny&) = default;
};

/// The one of the greatest area inside the polygon with a side on an edge of the polygon, which
/// goes from vertex `edge` to the next. The axes are turned as for InscribedAny.
struct InscribedAtEdge {
  int edge = 0;

  friend bool operator==(const InscribedAtEdge&, const InscribedAtEdge&) = default;
};

/// This one, which may reach beyond the polygon. Its axes are the basis, turned by the angle from p
/// towards q; its first corner is put on the plane along the normal, from any distance, so that one
/// rectangle serves all planes of a series. Micrometres; width and height are above 0.
struct Custom {
  Vector3 corner;
  double width = 0.0;
  double height = 0.0;
  double angle_degrees = 0.0;

  friend bool operator==(const Custom&, const Custom&) = default;
};

}  // namespace theta

using ThetaChoice = std::variant<theta::Bounding, theta::Inscribed, theta::InscribedAny,
                                 theta::InscribedAtEdge, theta::Custom>;

/// `polygon` has three vertices or more, as section_polygon gives them, and lies in the plane of
/// `basis`. Inscribed rectangles lie in it to within 10⁻¹⁴ of its diameter; where one of the
/// greatest area can be moved, it is in the middle of where it can be.
/// Throws InvalidRequest for an edge that the polygon does not have and for a custom rectangle that
/// is none, SampleError when the polygon is too thin to hold a rectangle.
ThetaRectangle theta_rectangle(const ThetaChoice& choice, std::span<const Vector3> polygon,
                               const SectionBasis& basis);

}  // namespace biotomy::reconstruct
