#pragma once

#include <filesystem>

namespace biotomy::reconstruct {

/// Throws SampleError where a finished folder could not be given the name `place` by a rename:
/// where there is anything but an empty folder, and where it is a symbolic link or a mount point.
/// To be asked before the work, which would be for nothing.
void check_place_is_free(const std::filesystem::path& place);

}  // namespace biotomy::reconstruct
