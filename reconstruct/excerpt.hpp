#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace biotomy::reconstruct {

/// The beginning of a text, so many bytes at most and never half a UTF-8 character.
std::string_view beginning_of(std::string_view text, std::size_t most_bytes);

/// Text out of a file or a request as it can stand in a message of one line: its beginning, 80
/// bytes at most and never half a UTF-8 character, with control characters shown as '?'. What is
/// left out is told by an ellipsis.
std::string excerpt(std::string_view text);

}  // namespace biotomy::reconstruct
