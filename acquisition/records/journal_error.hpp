#pragma once

#include <stdexcept>

namespace biotomy::acquisition {

/// The journal cannot be opened, read or written; the message names it.
class JournalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace biotomy::acquisition
