#pragma once

#include <span>
#include <string_view>

namespace biotomy::reconstruct {

/// The one of `words` that `word` was probably meant to be: with the fewest letters to add, drop or
/// change (Levenshtein's distance), at most a third of its own and at least 2. Empty if there is
/// none.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> words);

}  // namespace biotomy::reconstruct
