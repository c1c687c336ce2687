#pragma once

#include <cstdint>

namespace biotomy::tests {

/// What a program did to a disk; `start` is its own beginning, `failed_sync` a sync that was
/// answered by an error.
enum class DiskCall : std::uint32_t {
  start,
  create,
  write,
  truncate,
  sync,
  failed_sync,
  rename,
  remove,
  make_folder
};

/// One call that was done, as it stands in the log of disk_recorder.cpp. After it come its path,
/// the path that a rename leads to, and the data of a write. The paths are those below the folder
/// that is recorded; the folder's own is empty.
struct DiskRecord {
  DiskCall call = DiskCall::write;
  std::uint32_t path_size = 0;
  std::uint32_t to_size = 0;
  std::uint32_t reserved = 0;
  std::int64_t time_ns = 0;  ///< when it had been done, since the epoch
  std::uint64_t node = 0;    ///< the file's number, which is used again after it is removed
  std::uint64_t offset = 0;  ///< of a write; the size left by a truncate; of a sync the number of
                             ///< records since `start`, with it, when the sync began
  std::uint64_t data_size = 0;  ///< of a write
};

}  // namespace biotomy::tests
