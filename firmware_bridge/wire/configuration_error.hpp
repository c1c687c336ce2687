#pragma once

#include <stdexcept>
#include <string>

namespace biotomy::bridge {

/// A file, a key or an option that was written wrongly: nothing runs until a person mends it.
/// The message is one line with file, line number, key, what was wrong and what was expected.
/// A main() that catches it exits with 2.
class ConfigurationError : public std::invalid_argument {
 public:
  explicit ConfigurationError(const std::string& message) : std::invalid_argument(message) {}
};

}  // namespace biotomy::bridge
