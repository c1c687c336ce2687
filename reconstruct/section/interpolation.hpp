#pragma once

#include <string>

namespace biotomy::reconstruct {

/// How the colour between voxel centres is made. Each kernel's contract (radius, support, edges)
/// stands in texel_kernels.hpp.
enum class Interpolation { nearest, linear, cubic };

/// The name as it is written in options; throws InvalidRequest with the names there are.
Interpolation interpolation(const std::string& name);

}  // namespace biotomy::reconstruct
