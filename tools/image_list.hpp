#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace biotomy::tools {

/// The images that a command line names: files as they stand, and of each folder its PNG, TIFF and
/// JPEG files in the order of their names, numbers by their value (2 before 10). Hidden files are
/// left out. Throws SampleError for what is not there or has no image in it.
std::vector<std::filesystem::path> list_images(const std::vector<std::string>& inputs);

/// Whether one name comes before another: digits are compared as numbers, the rest as text.
bool comes_before(const std::string& one, const std::string& another);

}  // namespace biotomy::tools
