#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

#include "acquisition/viewer/refusal.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::tests {

inline void require(bool holds, const std::string& what) {
  if (!holds) throw std::logic_error(what);
}

/// A message as a user can read it: one line, not a page of the file, and it begins with the name.
inline void require_clear(const std::string& message, const std::string& name) {
  constexpr std::size_t kLongest = 600;
  require(message.compare(0, name.size(), name) == 0, "does not begin with its name: " + message);
  require(std::none_of(message.begin(), message.end(),
                       [](char c) { return static_cast<unsigned char>(c) < ' '; }),
          "is not one line of text: " + message);
  require(message.size() <= name.size() + kLongest, "is too long: " + message);
}

/// Whether the reader took what it was given. A refusal must be clear.
template <typename Reader>
bool accepts(const std::string& name, Reader&& reader) {
  try {
    reader();
    return true;
  } catch (const reconstruct::SampleError& error) {
    require_clear(error.what(), name);
  } catch (const reconstruct::InvalidRequest& error) {
    require_clear(error.what(), name);
  } catch (const acquisition::Refusal& error) {
    require_clear(error.what(), name);
  }
  return false;
}

}  // namespace biotomy::tests
