#pragma once

#include <filesystem>

#include "reconstruct/geometry/plane.hpp"

namespace biotomy::reconstruct {

/// The plane of a section that was cut before, out of its sidecar (`.json`) or of the record in its
/// picture (PNG, TIFF): the very plane, to the bit. Throws SampleError, naming the file, where it
/// can't be read or names no plane.
Plane recorded_plane(const std::filesystem::path& file);

}  // namespace biotomy::reconstruct
