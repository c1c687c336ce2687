#pragma once

#include <string>

#include "tests/quality/set_results.hpp"

namespace biotomy::tests {

/// The results as they stand in docs/quality.md: two tables and what was found on good frames.
std::string markdown(const SetResults& results);

/// The same, and points of each metric's receiver operating characteristic, as one JSON object.
std::string json(const SetResults& results);

/// A line for each frame that was answered wrongly.
std::string wrong_answers(const std::vector<JudgedFrame>& frames);

}  // namespace biotomy::tests
