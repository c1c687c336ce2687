#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/http/message.hpp"

namespace biotomy::acquisition {

/// A whole number without sign or blanks; nothing when it is something else or not in the range.
std::optional<std::int64_t> whole_number(std::string_view text, std::int64_t least,
                                         std::int64_t most);

/// The number under `name` of a query, or `fallback` when it is not there. Throws InvalidRequest
/// that says "NAME must be WANTED".
std::int64_t number_in(const ApiRequest& request, const std::string& name, std::int64_t fallback,
                       std::int64_t least, std::int64_t most, const std::string& wanted);

/// The words of a list, empty ones too: "a//b" by '/' is "a", "", "b".
std::vector<std::string> words_between(std::string_view text, char separator);

}  // namespace biotomy::acquisition
