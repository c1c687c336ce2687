#include "acquisition/records/journal_summary.hpp"

#include <SQLiteCpp/SQLiteCpp.h>

#include "acquisition/records/journal_error.hpp"

namespace biotomy::acquisition {

JournalSummary summary_of(SQLite::Database& database, const std::filesystem::path& journal) {
  JournalSummary summary;
  SQLite::Statement last(database, "SELECT count(*), coalesce(max(layer), 0) FROM layers");
  last.executeStep();
  summary.last_committed = last.getColumn(1).getInt64();
  if (last.getColumn(0).getInt64() != summary.last_committed) {
    throw JournalError("the journal " + journal.string() +
                       " has committed layers with gaps between them: it is damaged");
  }

  SQLite::Statement attempt(database,
                            "SELECT coalesce(max(attempt), 0) FROM attempts WHERE layer = ?");
  attempt.bind(1, summary.last_committed + 1);
  attempt.executeStep();
  summary.last_attempt = attempt.getColumn(0).getInt();

  SQLite::Statement bytes(database, "SELECT bytes FROM layers WHERE layer = ?");
  bytes.bind(1, summary.last_committed);
  if (bytes.executeStep()) {
    summary.last_layer_bytes = static_cast<std::uint64_t>(bytes.getColumn(0).getInt64());
  }

  SQLite::Statement unflagged(database,
                              "SELECT layers.layer FROM layers JOIN attempts "
                              "ON attempts.id = layers.attempt_id WHERE verdict <> ? "
                              "ORDER BY layers.layer DESC LIMIT 1");
  unflagged.bind(1, to_string(Verdict::accepted_with_flag));
  const std::int64_t last_good = unflagged.executeStep() ? unflagged.getColumn(0).getInt64() : 0;
  summary.flagged_in_a_row = static_cast<int>(summary.last_committed - last_good);

  SQLite::Statement grind(database,
                          "SELECT sequence, layer, target_um, ground_before_um, count_before, "
                          "coalesce(result, '') FROM grinds ORDER BY sequence DESC LIMIT 1");
  if (grind.executeStep()) {
    summary.last_sequence = static_cast<std::uint32_t>(grind.getColumn(0).getInt64());
    summary.last_grind = GrindRow{.sequence = summary.last_sequence,
                                  .layer = grind.getColumn(1).getInt64(),
                                  .target = {grind.getColumn(2).getDouble()},
                                  .ground_before = {grind.getColumn(3).getDouble()},
                                  .count_before = grind.getColumn(4).getInt64(),
                                  .finished = grind.getColumn(5).getString() ==
                                              bridge::to_string(bridge::CommandResult::done)};
  }

  // A daemon that takes over a job writes that it is latched, by a clock that may not be set yet.
  summary.last_event_at =
      database
          .execAndGet(
              "SELECT coalesce((SELECT at FROM events WHERE NOT (kind = 'state' AND "
              "state = 'faulted') ORDER BY id DESC LIMIT 1), '')")
          .getString();

  // A layer's last frame was taken after the last of its searches: a job that searched for a layer
  // and stored no frame of it searches again. A frame that was stored with a flag need not be the
  // last.
  SQLite::Statement focus(
      database,
      "SELECT focus_sweeps.layer, why, focus_sweeps.column_um, sharpness FROM focus_sweeps "
      "JOIN layers ON layers.layer = focus_sweeps.layer WHERE found = 1 AND "
      "focus_sweeps.id IN (SELECT max(id) FROM focus_sweeps GROUP BY layer) AND "
      "attempt_id = (SELECT id FROM attempts WHERE attempts.layer = layers.layer "
      "ORDER BY attempt DESC LIMIT 1) ORDER BY focus_sweeps.id DESC LIMIT 1");
  if (focus.executeStep()) {
    summary.last_focus = FocusRow{.layer = focus.getColumn(0).getInt64(),
                                  .why = focus.getColumn(1).getString(),
                                  .column = {focus.getColumn(2).getDouble()},
                                  .sharpness = focus.getColumn(3).getDouble(),
                                  .found = true,
                                  .points = {},
                                  .lean = {}};
  }

  SQLite::Statement doubt(database, "SELECT 1 FROM focus_sweeps WHERE layer > ? LIMIT 1");
  doubt.bind(1, summary.last_committed);
  summary.focus_in_doubt = doubt.executeStep();

  SQLite::Statement constants(database, "SELECT name, value FROM constants ORDER BY name");
  while (constants.executeStep()) {
    summary.constants.push_back(
        {constants.getColumn(0).getString(), constants.getColumn(1).getString()});
  }
  return summary;
}

}  // namespace biotomy::acquisition
