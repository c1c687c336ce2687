#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "reconstruct/geometry/vector3.hpp"

namespace biotomy::bench {

/// A plane as the files of planes have it (planes.txt): a name and three points, in voxels.
struct NamedPlane {
  std::string name;
  std::array<reconstruct::Vector3, 3> points;
};

/// One plane a line, `name` and nine numbers; empty lines and those that begin with # are comments.
/// With `only`, the plane of this name alone. Throws SampleError that names the file and the line,
/// and InvalidRequest when there is no plane (of this name).
std::vector<NamedPlane> read_planes(const std::filesystem::path& file,
                                    const std::string& only = {});

}  // namespace biotomy::bench
