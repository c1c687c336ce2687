#pragma once

#include <filesystem>

namespace biotomy::reconstruct {

/// The folder's absolute path, without a slash at its end: `knee/` is what `knee` is, and names
/// that are made of a folder's are the same for both.
std::filesystem::path absolute_folder(const std::filesystem::path& folder);

}  // namespace biotomy::reconstruct
