#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace biotomy::tests {

/// The lines of a twin's witness log, also of one that is still being written: the last counts only
/// once its newline is there. Of a log that is not there yet: none.
std::vector<std::string> witness_lines(const std::filesystem::path& log);

}  // namespace biotomy::tests
