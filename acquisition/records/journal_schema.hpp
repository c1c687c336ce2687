#pragma once

#include <filesystem>

namespace SQLite {  // NOLINT(readability-identifier-naming): the library's
class Database;
}

namespace biotomy::acquisition {

/// The version that this program writes, kept in the journal's `PRAGMA user_version`.
int journal_version();

/// Brings an opened journal to `journal_version()`, step by step, each step in a transaction of its
/// own. `journal` stands for the file in messages. Throws JournalError for a journal of a newer
/// program.
void migrate_journal(SQLite::Database& database, const std::filesystem::path& journal);

/// Throws JournalError unless the journal has exactly this program's version.
void check_journal_version(SQLite::Database& database, const std::filesystem::path& journal);

}  // namespace biotomy::acquisition
