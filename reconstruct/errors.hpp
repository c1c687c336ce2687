#pragma once

#include <stdexcept>

namespace biotomy::reconstruct {

/// What was asked can never work, whatever the sample holds: three points on a line, a spacing of
/// zero. The tools exit with 2.
class InvalidRequest : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// What was asked does not fit this sample or this file: a plane that misses it, a truncated image,
/// a damaged chunk. The tools exit with 1.
class SampleError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace biotomy::reconstruct
