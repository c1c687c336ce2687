#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace biotomy::bridge {

/// The candidate that `name` was probably meant to be: the one with the least edit distance
/// (Levenshtein; a swap of neighbours counts as one), unless more than a third of the name would
/// have to change. Empty if there is none.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace biotomy::bridge
