#pragma once

#include <nlohmann/json.hpp>

namespace CLI {
class App;
}

namespace biotomy::tools {

/// What a command was asked to do, as it was typed: its arguments and options by name, with the
/// defaults of those that were not given and have one. What says only where the result goes or how
/// it is made (--output, --movie, --rate, --cache-mb, --stats, --json) is not part of it: the
/// result is the same without.
nlohmann::ordered_json command_parameters(const CLI::App& command);

}  // namespace biotomy::tools
