#pragma once

#include <filesystem>

#include "acquisition/records/journal_rows.hpp"

namespace SQLite {  // NOLINT(readability-identifier-naming): the library's
class Database;
}

namespace biotomy::acquisition {

/// What the job must know of its own past, out of an opened journal of this program's version.
/// Throws SQLite::Exception, and JournalError when committed layers are missing between others.
JournalSummary summary_of(SQLite::Database& database, const std::filesystem::path& journal);

}  // namespace biotomy::acquisition
