#pragma once

#include <exception>
#include <string>

namespace biotomy::reconstruct {

/// What a user is told of a failure, on one line: the exception's text, of whichever library, or
/// that there is not enough memory.
std::string failure_text(const std::exception& error);

}  // namespace biotomy::reconstruct
