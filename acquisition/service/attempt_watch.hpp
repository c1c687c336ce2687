#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/records/journal_rows.hpp"

namespace biotomy::acquisition {

/// Looks again and again at the journal for attempts that are new in it. As long as nothing was
/// written to the journal's files, it asks SQLite nothing.
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
  /// Changes with everything that is written.
  std::string files_state() const;

  std::filesystem::path journal_;
  std::string seen_;  ///< the files' state at the last look
  mutable std::mutex mutex_;
  std::optional<AttemptNote> last_;
};

/// Attempts that a listener missed, told after `id` and not after `until`; nothing when they cannot
/// be told one by one: there are more than a thousand, or the journal does not know that id.
std::optional<std::vector<AttemptNote>> missed_attempts(const std::filesystem::path& journal,
                                                        std::int64_t id, std::int64_t until);

}  // namespace biotomy::acquisition
