#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace biotomy::tests {

/// What faulty_disk.cpp is told to do to files below `folder`.
struct Fault {
  std::filesystem::path folder;
  std::string call = {};           ///< create, mkdir, read, write, sync or rename
  std::int64_t at = 0;             ///< from the at-th such call on they fail; 0: none by number
  std::int64_t times = 0;          ///< so many of them; 0: all
  std::int64_t after_renames = 0;  ///< the number counts from the end of so many renames on
  std::string error = "ENOSPC";    ///< ENOSPC, EIO or EROFS
  std::int64_t space = 0;          ///< so many bytes can still be written; 0: any number
  std::int64_t most_bytes = 0;     ///< one write or read transfers at most so many; 0: any number
  bool cannot_exchange = false;    ///< its file system cannot let two names change places
  std::filesystem::path healed_by = {};  ///< once there is such a file, nothing fails any more
};

/// The environment that loads the fault into a program. When `counts` is named, the numbers of
/// calls go there.
inline std::vector<std::string> environment_of(const Fault& fault,
                                               const std::filesystem::path& counts = {}) {
  return {
      "LD_PRELOAD=" BIOTOMY_FAULTY_DISK,
      "BIOTOMY_FAULT_FOLDER=" + fault.folder.string(),
      "BIOTOMY_FAULT_CALL=" + fault.call,
      "BIOTOMY_FAULT_ERROR=" + fault.error,
      "BIOTOMY_FAULT_AT=" + std::to_string(fault.at),
      "BIOTOMY_FAULT_TIMES=" + std::to_string(fault.times),
      "BIOTOMY_FAULT_AFTER_RENAMES=" + std::to_string(fault.after_renames),
      "BIOTOMY_FAULT_HEALED_BY=" + fault.healed_by.string(),
      "BIOTOMY_FAULT_SPACE=" + std::to_string(fault.space),
      "BIOTOMY_FAULT_MOST_BYTES=" + std::to_string(fault.most_bytes),
      "BIOTOMY_FAULT_CANNOT_EXCHANGE=" + std::to_string(static_cast<int>(fault.cannot_exchange)),
      "BIOTOMY_FAULT_COUNTS=" + counts.string(),
  };
}

/// The command as it runs under the fault.
inline std::vector<std::string> under(const Fault& fault, const std::vector<std::string>& command,
                                      const std::filesystem::path& counts = {}) {
  std::vector<std::string> words = environment_of(fault, counts);
  words.insert(words.begin(), "/usr/bin/env");
  words.insert(words.end(), command.begin(), command.end());
  return words;
}

}  // namespace biotomy::tests
