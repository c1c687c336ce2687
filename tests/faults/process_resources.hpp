#pragma once

#include <cstdint>

#include <sys/types.h>

namespace biotomy::tests {

/// What a process holds at a moment, by /proc.
struct ProcessResources {
  std::int64_t resident_kib = 0;
  std::int64_t open_files = 0;
  std::int64_t threads = 0;
};

/// Throws std::runtime_error when the process is not there.
ProcessResources resources_of(pid_t process);

}  // namespace biotomy::tests
