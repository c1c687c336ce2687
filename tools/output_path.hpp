#pragma once

#include <filesystem>
#include <string>

namespace biotomy::tools {

/// Throws InvalidRequest that names the option when what would be written to `output`, a file or a
/// folder that need not be there yet, would lie in a sample's folder or be one: in any folder with
/// a `sample.toml`, whatever links lead there.
void refuse_output_in_sample(const std::string& option, const std::filesystem::path& output);

}  // namespace biotomy::tools
