#pragma once

#include <string>

#include "reconstruct/geometry/plane.hpp"

namespace biotomy::reconstruct {

/// Two directions of length 1 in a plane, at right angles: the picture's columns advance along `p`,
/// its rows along `q`.
struct SectionBasis {
  Vector3 p;
  Vector3 q;
};

/// How the picture lies in the plane Ax + By + Cz + D = 0 (Khoperskov et al. 2017, whose ξ_z lacks
/// its root and whose M lacks its square).
///  - layer: p = (−B, A, 0)/√(A²+B²), q = (−AC, −BC, A²+B²)/M, M = √(A²C²+B²C²+(A²+B²)²). Rows lie
///    in the layers. Where A = B = 0, p = (1, 0, 0) and q = (0, 1, 0).
///  - xz: p = ξ = (C, 0, −A)/√(A²+C²), q = η = (−AB, A²+C², −BC)/L, L = √(A²B²+(A²+C²)²+B²C²). Rows
///    lie in x–z planes. Where A = C = 0, p = (1, 0, 0) and q = (0, 0, 1).
/// Signs, the same whatever the sign of the normal: layer has q_z ≥ 0 and p_x > 0, or p_x = 0 and
/// p_y > 0; xz has q_y ≥ 0 and p_x > 0, or p_x = 0 and p_z > 0.
enum class BasisKind { layer, xz };

/// The name as it is written in options; throws InvalidRequest with the names there are.
BasisKind basis_kind(const std::string& name);

/// Orthonormal to ±10⁻¹⁵.
SectionBasis section_basis(BasisKind kind, const Plane& plane);

}  // namespace biotomy::reconstruct
