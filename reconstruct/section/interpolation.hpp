#pragma once

#include <string>

namespace biotomy::reconstruct {

/// How the colour between voxel centres is made. Each kernel's contract (radius, support, edges)
/// stands at the head of its file: nearest_kernel.hpp, linear_kernel.hpp.
enum class Interpolation { nearest, linear };

/// The name as it is written in options; throws InvalidRequest with the names there are.
Interpolation interpolation(const std::string& name);

}  // namespace biotomy::reconstruct
