#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/records/journal_rows.hpp"

namespace biotomy::acquisition {

/// Looks again and again at the journal for attempts that are new in it. Of a journal that nobody
/// has open, and to whose files nothing was written, it asks SQLite nothing.
/// It opens none of the journal's files itself: with the first descriptor of a file that a process
/// closes it loses all its locks on that file (fcntl(2), "Record locking and file descriptors"),
/// SQLite's too. Another program that opens the journal then takes itself for the only one, and
/// cuts the index that the writer has mapped, who dies of SIGBUS.
class AttemptWatch {
 public:
  /// Attempts that are in the journal by now are not new. The journal need not be there yet.
  explicit AttemptWatch(std::filesystem::path journal);

  /// The attempts since the last look, in their order, at most a thousand. One thread looks. Throws
  /// JournalError.
  std::vector<AttemptNote> look();

  /// The last attempt in the journal, as it was at the last look; for any thread.
  std::optional<AttemptNote> last() const;

 private:
  /// Changes with everything that is written; not always with the commit of what was written
  /// before.
  std::string files_state() const;

  /// Whether the write-ahead log is empty, or gone: then nothing can be committed without a write.
  bool is_at_rest() const;

  std::filesystem::path journal_;
  std::filesystem::path log_;
  std::string seen_;  ///< the files' state at the last look
  mutable std::mutex mutex_;
  std::optional<AttemptNote> last_;
};

/// Attempts that a listener missed, told after `id` and not after `until`; nothing when they cannot
/// be told one by one: there are more than a thousand, or the journal does not know that id.
std::optional<std::vector<AttemptNote>> missed_attempts(const std::filesystem::path& journal,
                                                        std::int64_t id, std::int64_t until);

}  // namespace biotomy::acquisition
