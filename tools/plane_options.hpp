#pragma once

#include "reconstruct/section/parameter_text.hpp"

namespace CLI {
class App;
}

namespace biotomy::tools {

/// The options that say which plane a command cuts along, as they were typed. The command leaves
/// arguments that it does not know to `take_unquoted_points`.
void add_plane_options(CLI::App& command, reconstruct::PlaneText& plane);

/// To be called first in the command's callback. Three points that no quotes hold together came as
/// an option with one and two arguments too many: they become one text again. Throws InvalidRequest
/// for any other argument that the command does not know.
void take_unquoted_points(CLI::App& command);

}  // namespace biotomy::tools
