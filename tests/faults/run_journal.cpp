#include "tests/faults/run_journal.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <nlohmann/json.hpp>

#include "tests/temporary_folder.hpp"

namespace biotomy::tests {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTrial = "trial frame ";

template <typename Row, typename Make>
std::vector<Row> rows(const SQLite::Database& database, const char* query, Make make) {
  std::vector<Row> found;
  SQLite::Statement select(database, query);
  while (select.executeStep()) found.push_back(make(select));
  return found;
}

RunJournal::Search search_of(SQLite::Statement& row) {
  RunJournal::Search search{
      .at = row.getColumn(0).getString(), .layer = row.getColumn(1).getInt64(), .columns_um = {}};
  for (const nlohmann::json& point : nlohmann::json::parse(row.getColumn(2).getString())) {
    search.columns_um.push_back(point.at(0));
  }
  return search;
}

/// The files of the journal, so far as they are there, in `folder`. The index of the log is left
/// out: it is made anew.
fs::path copy_of(const fs::path& journal, const fs::path& folder) {
  for (const char* part : {"-journal", "-wal", ""}) {
    const fs::path from = journal.string() + part;
    if (fs::exists(from)) fs::copy_file(from, folder / from.filename());
  }
  return folder / journal.filename();
}

}  // namespace

RunJournal read_run_journal(const std::filesystem::path& journal) {
  RunJournal run;
  if (!fs::exists(journal)) return run;
  const TemporaryFolder folder;
  SQLite::Database database(copy_of(journal, folder.path()).string(), SQLite::OPEN_READWRITE);
  if (!database.tableExists("events")) return run;
  run.grinds = rows<RunJournal::Grind>(
      database, "SELECT sequence, layer, target_um, intended_at FROM grinds ORDER BY sequence",
      [](SQLite::Statement& row) {
        return RunJournal::Grind{.sequence = row.getColumn(0).getUInt(),
                                 .layer = row.getColumn(1).getInt64(),
                                 .target_um = row.getColumn(2).getDouble(),
                                 .intended_at = row.getColumn(3).getString()};
      });
  run.attempts = rows<RunJournal::Attempt>(
      database,
      "SELECT layer, attempt, frame_sequence, taken_at, verdict FROM attempts ORDER BY id",
      [](SQLite::Statement& row) {
        return RunJournal::Attempt{.layer = row.getColumn(0).getInt64(),
                                   .attempt = row.getColumn(1).getInt(),
                                   .frame = static_cast<std::uint64_t>(row.getColumn(2).getInt64()),
                                   .taken_at = row.getColumn(3).getString(),
                                   .verdict = row.getColumn(4).getString()};
      });
  run.layers = rows<RunJournal::Layer>(
      database,
      "SELECT layers.layer, attempt, file, bytes, sha256, committed_at FROM layers "
      "JOIN attempts ON attempts.id = attempt_id ORDER BY layers.layer",
      [](SQLite::Statement& row) {
        return RunJournal::Layer{.layer = row.getColumn(0).getInt64(),
                                 .attempt = row.getColumn(1).getInt(),
                                 .file = row.getColumn(2).getString(),
                                 .bytes = static_cast<std::uint64_t>(row.getColumn(3).getInt64()),
                                 .sha256 = row.getColumn(4).getString(),
                                 .committed_at = row.getColumn(5).getString()};
      });
  run.searches = rows<RunJournal::Search>(
      database, "SELECT at, layer, points FROM focus_sweeps ORDER BY id", search_of);
  run.trials = rows<RunJournal::Trial>(
      database, "SELECT at, text FROM events WHERE text LIKE 'trial frame %' ORDER BY id",
      [](SQLite::Statement& row) {
        return RunJournal::Trial{
            .at = row.getColumn(0).getString(),
            .frame = std::stoull(row.getColumn(1).getString().substr(kTrial.size()))};
      });
  run.no_frame_at =
      rows<std::string>(database, "SELECT at FROM events WHERE text LIKE 'no frame: %' ORDER BY id",
                        [](SQLite::Statement& row) { return row.getColumn(0).getString(); });
  run.alarms = rows<RunJournal::Alarm>(
      database, "SELECT at, state, text FROM events WHERE kind = 'alarm' ORDER BY id",
      [](SQLite::Statement& row) {
        return RunJournal::Alarm{.at = row.getColumn(0).getString(),
                                 .state = row.getColumn(1).getString(),
                                 .cause = row.getColumn(2).getString()};
      });
  return run;
}

}  // namespace biotomy::tests
