#pragma once

#include <filesystem>
#include <stdexcept>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::acquisition {

/// Another daemon works on the sample, or the lock file cannot be made.
class SampleLockError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One daemon a sample: a lock on `.NAME.lock` beside the sample folder, held as long as the object
/// lives. The kernel gives it back when the daemon dies, however it dies.
class SampleLock {
 public:
  /// Throws SampleLockError.
  explicit SampleLock(const std::filesystem::path& sample);

  /// Whether a daemon works on the sample now. Nothing is made.
  static bool is_held(const std::filesystem::path& sample);

 private:
  bridge::UniqueFd file_;
};

}  // namespace biotomy::acquisition
