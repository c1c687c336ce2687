#pragma once

#include <optional>
#include <string>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/geometry/plane.hpp"
#include "reconstruct/geometry/theta_rectangle.hpp"
#include "reconstruct/section/sampler.hpp"

namespace biotomy::reconstruct {

// The parameters of sections as people write them, in the tool's options and in the HTTP API's
// query alike. `name` is what the parameter is called there; every InvalidRequest begins with it.

/// One decimal number, finite, nothing after it.
double parse_number(const std::string& name, const std::string& text);

/// Three numbers "a,b,c"; blanks around them are allowed.
Vector3 parse_vector(const std::string& name, const std::string& text);

/// "R,G,B", whole numbers from 0 to 255.
Colour parse_colour(const std::string& name, const std::string& text);

/// What lengths are given in. A position of (1, 1, 1) in voxels is (Δx, Δy, Δz); a mere length of 1
/// voxel is the least of the three.
enum class LengthUnit { micrometres, millimetres, voxels };

/// "um", "mm" or "voxel".
LengthUnit parse_unit(const std::string& name, const std::string& text);

Vector3 position_in_micrometres(const Vector3& position, LengthUnit unit, const Vector3& spacing);
double length_in_micrometres(double length, LengthUnit unit, const Vector3& spacing);

/// "bounding", "inscribed", "inscribed-any", "edge:I" with a whole number I from 0, or
/// "custom:X,Y,Z,W,H,ANGLE": a position and two lengths in the unit, both above 0, and degrees. A
/// refusal of another word names the one it was probably meant to be. Whether the section has an
/// edge I is only known when it is cut.
ThetaChoice parse_theta(const std::string& name, const std::string& text, LengthUnit unit,
                        const Vector3& spacing);

/// How a plane is asked for: by three points "x,y,z x,y,z x,y,z", or by a normal and a point, both
/// "x,y,z". Points are in the unit; the normal is a direction in space and has none.
struct PlaneText {
  std::optional<std::string> points;
  std::optional<std::string> normal;
  std::optional<std::string> through;
};

/// `prefix` goes before the names points, normal and through in messages: "--" in the tool.
/// Throws InvalidRequest when there are neither points nor a normal with its point, or both.
Plane parse_plane(const std::string& prefix, const PlaneText& text, LengthUnit unit,
                  const Vector3& spacing);

}  // namespace biotomy::reconstruct
