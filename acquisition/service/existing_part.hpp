#pragma once

#include <filesystem>

namespace biotomy::acquisition {

/// Of the folders that a path leads through, the last that is there already; empty when none is.
std::filesystem::path existing_part(std::filesystem::path path);

}  // namespace biotomy::acquisition
