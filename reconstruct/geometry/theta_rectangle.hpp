#pragma once

#include <span>
#include <string>

#include "reconstruct/geometry/section_basis.hpp"
#include "reconstruct/geometry/vector3.hpp"

namespace biotomy::reconstruct {

/// The rectangle of the section plane that becomes the picture. `origin` is its first corner, the
/// centre of pixel (0, 0); width goes along p and height along q, both in micrometres.
struct ThetaRectangle {
  Vector3 origin;
  SectionBasis axes;
  double width = 0.0;
  double height = 0.0;
};

/// How the rectangle is chosen for a section polygon.
///  - bounding: the smallest one along the basis that holds the polygon.
enum class ThetaKind { bounding };

/// The name as it is written in options; throws InvalidRequest with the names there are.
ThetaKind theta_kind(const std::string& name);

/// Its origin has the least coordinate along p and the least along q of `polygon`'s vertices, of
/// which there is at least one and which lie in the plane of `basis`.
ThetaRectangle theta_rectangle(ThetaKind kind, std::span<const Vector3> polygon,
                               const SectionBasis& basis);

}  // namespace biotomy::reconstruct
