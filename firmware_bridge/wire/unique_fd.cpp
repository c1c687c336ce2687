#include "firmware_bridge/wire/unique_fd.hpp"

#include <unistd.h>

namespace biotomy::bridge {

UniqueFd& UniqueFd::operator=(UniqueFd&& other) noexcept {
  if (this != &other) {
    reset();
    descriptor_ = std::exchange(other.descriptor_, -1);
  }
  return *this;
}

void UniqueFd::reset() {
  // Not tried again when interrupted: Linux has released the number by then, and another thread
  // may already have it.
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

}  // namespace biotomy::bridge
