#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace biotomy::acquisition {

/// What the sample's journal tells of the run before, as far as a daemon that starts must know it.
struct EarlierRun {
  std::uint32_t last_sequence = 0;  ///< the highest command number; 0 if none
  bool was_running = false;         ///< nobody stopped it: the daemon crashed, or the power was cut
  std::string alarm;                ///< that nobody acknowledged; empty if none
  std::int64_t committed = 0;       ///< layers that are safe
};

/// Reads it from the journal; a journal that is not there tells of nothing. Throws JournalError.
EarlierRun read_earlier_run(const std::filesystem::path& journal);

/// The same for a daemon that starts, and has the sample's lock; it writes down that it is latched.
/// Whatever comes before the job runs again, an alarm or a person's word, the daemon after this one
/// finds a job that was not running. Where the journal cannot be read, or that cannot be written,
/// as on a full disk, nothing goes on by itself now. `utc` as in JobEventRow.
EarlierRun take_over_earlier_run(const std::filesystem::path& sample, const std::string& utc);

}  // namespace biotomy::acquisition
