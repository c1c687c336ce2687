#include "acquisition/records/journal_schema.hpp"

#include <array>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

#include "acquisition/records/journal_error.hpp"

namespace biotomy::acquisition {
namespace {

// A step leads from version i to version i + 1. Steps that were released are never changed; what is
// new is a new step.
constexpr std::array kSteps = {
    R"sql(
-- Every pass of the wheel, written down and committed before the command is issued.
CREATE TABLE grinds (
  sequence          INTEGER PRIMARY KEY,  -- the command's number, echoed by the controller
  layer             INTEGER NOT NULL,
  target_um         REAL    NOT NULL,
  ground_before_um  REAL    NOT NULL,     -- the controller's ground_position before
  count_before      INTEGER NOT NULL,     -- the controller's grind_count before
  intended_at       TEXT    NOT NULL,     -- times are ISO 8601, UTC
  finished_at       TEXT,                 -- NULL: nobody saw how it ended
  result            TEXT,                 -- done, refused, aborted
  telemetry         TEXT                  -- JSON, as the pass ended
);
CREATE INDEX grinds_by_layer ON grinds (layer);

-- Every frame that was taken, and what was thought of it.
CREATE TABLE attempts (
  id              INTEGER PRIMARY KEY,
  layer           INTEGER NOT NULL,
  attempt         INTEGER NOT NULL,       -- from 1 within the layer
  taken_at        TEXT    NOT NULL,
  frame_sequence  INTEGER NOT NULL,
  exposure_us     INTEGER NOT NULL,
  gain            REAL    NOT NULL,
  column_um       REAL    NOT NULL,
  verdict         TEXT    NOT NULL
    CHECK (verdict IN ('accepted', 'accepted_with_flag', 'rejected', 'not_stored')),
  slug            TEXT    NOT NULL,
  reason          TEXT    NOT NULL,
  metrics         TEXT    NOT NULL,       -- JSON: [{name, value, limit, passed}]
  file            TEXT    NOT NULL,       -- relative to the sample folder; '' if none was kept
  sha256          TEXT    NOT NULL,
  telemetry       TEXT    NOT NULL,       -- JSON: the controller as the frame was taken
  UNIQUE (layer, attempt)
);

-- Layers whose image is on disk: they are never taken again.
CREATE TABLE layers (
  layer         INTEGER PRIMARY KEY,
  attempt_id    INTEGER NOT NULL REFERENCES attempts (id),
  bytes         INTEGER NOT NULL,
  committed_at  TEXT    NOT NULL
);

CREATE TABLE focus_sweeps (
  id         INTEGER PRIMARY KEY,
  at         TEXT    NOT NULL,
  layer      INTEGER NOT NULL,
  why        TEXT    NOT NULL,
  found      INTEGER NOT NULL,
  column_um  REAL    NOT NULL,            -- of the peak
  sharpness  REAL    NOT NULL,
  points     TEXT    NOT NULL             -- JSON: [[column_um, sharpness]]
);

-- What happened beside: states, alarms, operators' commands.
CREATE TABLE events (
  id     INTEGER PRIMARY KEY,
  at     TEXT    NOT NULL,
  kind   TEXT    NOT NULL CHECK (kind IN ('state', 'alarm', 'operator', 'recovery')),
  state  TEXT    NOT NULL,
  layer  INTEGER NOT NULL,
  text   TEXT    NOT NULL
);
)sql",
    R"sql(
-- JSON: {across_um, down_um, angle_degrees, tiles}: how the face leans; NULL where it did not tell.
ALTER TABLE focus_sweeps ADD COLUMN lean TEXT;

-- What is the same for all layers of the sample: how they are photographed.
CREATE TABLE constants (
  name   TEXT PRIMARY KEY,                -- a key of the configuration
  value  TEXT NOT NULL
);
)sql",
};

int version_of(SQLite::Database& database) {
  return database.execAndGet("PRAGMA user_version").getInt();
}

[[noreturn]] void refuse(const std::filesystem::path& journal, int version) {
  throw JournalError(
      "the journal " + journal.string() + " has version " + std::to_string(version) +
      " and this program knows version " + std::to_string(journal_version()) +
      (version > journal_version() ? ": use the newer program" : ": open it once with biotomyd"));
}

}  // namespace

int journal_version() {
  return static_cast<int>(kSteps.size());
}

void migrate_journal(SQLite::Database& database, const std::filesystem::path& journal) {
  const int found = version_of(database);
  if (found < 0 || found > journal_version()) refuse(journal, found);
  for (int version = found; version < journal_version(); ++version) {
    SQLite::Transaction transaction(database);
    database.exec(kSteps[static_cast<std::size_t>(version)]);
    database.exec("PRAGMA user_version = " + std::to_string(version + 1));
    transaction.commit();
  }
}

void check_journal_version(SQLite::Database& database, const std::filesystem::path& journal) {
  const int found = version_of(database);
  if (found != journal_version()) refuse(journal, found);
}

}  // namespace biotomy::acquisition
