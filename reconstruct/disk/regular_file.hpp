#pragma once

#include <filesystem>

#include "reconstruct/disk/file_descriptor.hpp"

namespace biotomy::reconstruct {

/// Opens a file for reading. Throws SampleError, naming it, where it cannot be opened and where it
/// is no regular file: a pipe, of which one would wait for the other end, or a device.
FileDescriptor open_regular_file(const std::filesystem::path& path);

}  // namespace biotomy::reconstruct
