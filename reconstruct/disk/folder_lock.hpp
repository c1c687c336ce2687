#pragma once

#include <filesystem>
#include <string>

#include "reconstruct/disk/file_descriptor.hpp"

namespace biotomy::reconstruct {

/// Makes the folder, where it is not there yet, and locks it for as long as the descriptor lives:
/// the kernel gives it back however a program ends. `taken` is what to say when another has the
/// lock. Throws SampleError.
FileDescriptor make_locked_folder(const std::filesystem::path& folder, const std::string& taken);

}  // namespace biotomy::reconstruct
