#pragma once

#include <functional>
#include <string>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {

/// Asked between two pieces of a long work, by any of its threads; true: stop here.
using StopRequested = std::function<bool()>;

/// The work was stopped because it was asked to; nothing is half done.
class Interrupted : public SampleError {
 public:
  using SampleError::SampleError;
};

/// Throws Interrupted, which says `message`, when asked to stop. Without a question nothing stops.
inline void stop_here_if(const StopRequested& requested, const std::string& message) {
  if (requested && requested()) {
    throw Interrupted(message);
  }
}

}  // namespace biotomy::reconstruct
