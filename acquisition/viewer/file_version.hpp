#pragma once

#include <filesystem>
#include <string>

#include <sys/stat.h>

namespace biotomy::acquisition {

/// What tells one content of a file from another where it is replaced, never written in place:
/// number, size and time. Empty when there is no such file.
std::string file_version(const std::filesystem::path& file);
std::string file_version(const struct stat& status);

}  // namespace biotomy::acquisition
