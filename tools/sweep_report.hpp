#pragma once

#include <filesystem>
#include <ostream>
#include <vector>

#include "acquisition/quality/focus_sweep.hpp"

namespace biotomy::tools {

/// A line for each frame of a sweep, then the sharpest and where the focus lies.
void print_sweep(std::ostream& out, const std::vector<std::filesystem::path>& files,
                 const acquisition::SweepRanking& ranking);

/// The same as one JSON document.
void print_sweep_json(std::ostream& out, const std::vector<std::filesystem::path>& files,
                      const acquisition::SweepRanking& ranking);

}  // namespace biotomy::tools
