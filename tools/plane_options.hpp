#pragma once

#include <optional>
#include <string>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/geometry/plane.hpp"
#include "reconstruct/section/parameter_text.hpp"

namespace CLI {
class App;
}

namespace biotomy::tools {

/// Which plane a command cuts along, as it was typed.
struct PlaneOptions : reconstruct::PlaneText {
  std::optional<std::string> layer;
  std::optional<std::string> tilt;
  std::optional<std::string> azimuth;
  std::optional<std::string> earlier_section;
};

/// The command leaves arguments that it does not know to `take_unquoted_points`.
void add_plane_options(CLI::App& command, PlaneOptions& options);

/// To be called first in the command's callback. Three points that no quotes hold together came as
/// an option with one and two arguments too many: they become one text again. Throws InvalidRequest
/// for any other argument that the command does not know.
void take_unquoted_points(CLI::App& command);

/// The plane in a sample of this size: one of three points, a normal and a point, a layer, angles,
/// or an earlier section; layers and angles mean what they do in the page's explorer. Throws
/// InvalidRequest that names the option, SampleError for a layer that the sample does not have and
/// for a file that names no plane.
reconstruct::Plane plane_of(const PlaneOptions& options, reconstruct::LengthUnit unit,
                            const reconstruct::Cuboid& cuboid);

}  // namespace biotomy::tools
