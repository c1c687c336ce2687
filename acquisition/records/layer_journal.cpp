#include "acquisition/records/layer_journal.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>
#include <nlohmann/json.hpp>

#include "acquisition/focus/face_lean_json.hpp"
#include "acquisition/quality/metrics_json.hpp"
#include "acquisition/records/journal_error.hpp"
#include "acquisition/records/journal_schema.hpp"
#include "acquisition/records/journal_summary.hpp"
#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::acquisition {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kBusyTimeoutMs = 5000;
constexpr milliseconds kBusyRetry(10);

std::string telemetry_json(const bridge::StageStatus& status) {
  return json{{"feed_um", status.feed.value},
              {"traverse_um", status.traverse.value},
              {"column_um", status.column.value},
              {"ground_to_um", status.ground_to.value},
              {"grind_count", status.grind_count},
              {"spindle_rpm", status.spindle_rpm},
              {"spindle_load_percent", status.spindle_load_percent},
              {"vibration_mm_s", status.vibration_mm_s},
              {"block_temperature_c", status.block_temperature_c},
              {"chamber_temperature_c", status.chamber_temperature_c}}
      .dump();
}

std::string points_json(const std::vector<FocusRow::Point>& points) {
  json list = json::array();
  for (const FocusRow::Point& point : points) {
    list.push_back({point.column.value, point.sharpness});
  }
  return list.dump();
}

/// Runs a piece of work on the database and names the journal in what goes wrong.
template <typename Work>
auto with_journal(const std::filesystem::path& path, Work work) {
  try {
    return work();
  } catch (const SQLite::Exception& error) {
    throw JournalError("the journal " + path.string() + ": " + error.what());
  }
}

/// Makes a journal with its tables, beside its name until it is whole: a daemon that is killed
/// meanwhile leaves a journal or none, never one that nobody can read.
void make_journal(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  const std::string fresh = path.parent_path() / ("." + path.filename().string() + ".new");
  std::error_code error;
  for (const char* part : {"", "-journal", "-wal", "-shm"}) fs::remove(fresh + part, error);
  {
    // Without a write-ahead log, which closing would move into the database without a word of what
    // goes wrong: so all is in the one file, and on the disk, or it is an error.
    SQLite::Database database(fresh, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyTimeoutMs);
    database.exec("PRAGMA synchronous = FULL");
    migrate_journal(database, path);
  }
  fs::rename(fresh, path, error);
  if (error) throw JournalError("the journal " + path.string() + ": " + error.message());
  try {
    reconstruct::sync_folder(path.parent_path());
  } catch (const reconstruct::SampleError& failure) {
    throw JournalError(failure.what());
  }
}

const std::filesystem::path& made(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) make_journal(path);
  return path;
}

}  // namespace

struct LayerJournal::State {
  std::filesystem::path path;
  SQLite::Database database;

  explicit State(const std::filesystem::path& journal_path)
      : path(made(journal_path)),
        database(journal_path.string(), SQLite::OPEN_READWRITE, kBusyTimeoutMs) {
    database.exec("PRAGMA journal_mode = WAL");
    database.exec("PRAGMA synchronous = FULL");
    database.exec("PRAGMA foreign_keys = ON");
    believe_only_the_disk();
    migrate_journal(database, path);
  }

  /// A journal that is opened may show commits that are not on the disk: those whose fsync failed
  /// are still in the page cache, which takes them for written, and no later fsync writes them. So
  /// all that the write-ahead log holds goes into the database anew, with an fsync of its own, and
  /// the log is begun anew, as what follows a hole in it would be lost with the hole.
  void believe_only_the_disk() {
    // For readers the checkpoint waits by itself. For whoever holds the checkpoint's own lock, as
    // another checkpoint does, it does not: see sqlite3_wal_checkpoint_v2.
    const auto deadline = steady_clock::now() + milliseconds(kBusyTimeoutMs);
    while (!moved_log_into_database()) {
      if (steady_clock::now() > deadline) {
        throw JournalError("the journal " + path.string() +
                           " is read by another program all the time: stop it first");
      }
      std::this_thread::sleep_for(kBusyRetry);
    }
  }

  bool moved_log_into_database() {
    SQLite::Statement checkpoint(database, "PRAGMA wal_checkpoint(TRUNCATE)");
    checkpoint.executeStep();
    return checkpoint.getColumn(0).getInt() == 0;
  }

  void insert_attempt(const AttemptRow& attempt) {
    SQLite::Statement insert(
        database,
        "INSERT INTO attempts (layer, attempt, taken_at, frame_sequence, exposure_us, gain, "
        "column_um, verdict, slug, reason, metrics, file, sha256, telemetry) "
        "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(1, attempt.layer);
    insert.bind(2, attempt.attempt);
    insert.bind(3, attempt.taken_at);
    insert.bind(4, static_cast<std::int64_t>(attempt.frame_sequence));
    insert.bind(5, attempt.exposure_us);
    insert.bind(6, attempt.gain);
    insert.bind(7, attempt.column.value);
    insert.bind(8, to_string(attempt.assessment.verdict));
    insert.bind(9, attempt.assessment.slug);
    insert.bind(10, attempt.assessment.reason);
    insert.bind(11, metrics_json(attempt.assessment.metrics).dump());
    insert.bind(12, attempt.file);
    insert.bind(13, attempt.sha256);
    insert.bind(14, telemetry_json(attempt.telemetry));
    insert.exec();
  }
};

LayerJournal::LayerJournal(const std::filesystem::path& path)
    : state_(with_journal(path, [&] { return std::make_unique<State>(path); })) {}

LayerJournal::~LayerJournal() = default;

void LayerJournal::begin_grind(const GrindRow& grind, const std::string& at) {
  with_journal(state_->path, [&] {
    SQLite::Statement insert(state_->database,
                             "INSERT INTO grinds (sequence, layer, target_um, ground_before_um, "
                             "count_before, intended_at) VALUES (?, ?, ?, ?, ?, ?)");
    insert.bind(1, static_cast<std::int64_t>(grind.sequence));
    insert.bind(2, grind.layer);
    insert.bind(3, grind.target.value);
    insert.bind(4, grind.ground_before.value);
    insert.bind(5, grind.count_before);
    insert.bind(6, at);
    insert.exec();
  });
}

void LayerJournal::end_grind(std::uint32_t sequence, bridge::CommandResult result,
                             const bridge::StageStatus& telemetry, const std::string& at) {
  with_journal(state_->path, [&] {
    SQLite::Statement update(
        state_->database,
        "UPDATE grinds SET finished_at = ?, result = ?, telemetry = ? WHERE sequence = ?");
    update.bind(1, at);
    update.bind(2, bridge::to_string(result));
    update.bind(3, telemetry_json(telemetry));
    update.bind(4, static_cast<std::int64_t>(sequence));
    update.exec();
  });
}

void LayerJournal::record_attempt(const AttemptRow& attempt) {
  with_journal(state_->path, [&] { state_->insert_attempt(attempt); });
}

void LayerJournal::record_focus(const FocusRow& focus, const std::string& at) {
  with_journal(state_->path, [&] {
    SQLite::Statement insert(state_->database,
                             "INSERT INTO focus_sweeps (at, layer, why, found, column_um, "
                             "sharpness, points, lean) VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(1, at);
    insert.bind(2, focus.layer);
    insert.bind(3, focus.why);
    insert.bind(4, focus.found ? 1 : 0);
    insert.bind(5, focus.column.value);
    insert.bind(6, focus.sharpness);
    insert.bind(7, points_json(focus.points));
    if (focus.lean) insert.bind(8, lean_json(focus.lean).dump());
    insert.exec();
  });
}

void LayerJournal::record_event(const JobEventRow& event) {
  with_journal(state_->path, [&] {
    SQLite::Statement insert(
        state_->database,
        "INSERT INTO events (at, kind, state, layer, text) VALUES (?, ?, ?, ?, ?)");
    insert.bind(1, event.at);
    insert.bind(2, event.kind);
    insert.bind(3, event.state);
    insert.bind(4, event.layer);
    insert.bind(5, event.text);
    insert.exec();
  });
}

void LayerJournal::record_constants(const std::vector<Constant>& constants) {
  with_journal(state_->path, [&] {
    SQLite::Transaction transaction(state_->database);
    state_->database.exec("DELETE FROM constants");
    for (const Constant& constant : constants) {
      SQLite::Statement insert(state_->database,
                               "INSERT INTO constants (name, value) VALUES (?, ?)");
      insert.bind(1, constant.name);
      insert.bind(2, constant.value);
      insert.exec();
    }
    transaction.commit();
  });
}

void LayerJournal::commit_layer(const AttemptRow& attempt, std::uint64_t bytes,
                                const std::string& at) {
  with_journal(state_->path, [&] {
    SQLite::Transaction transaction(state_->database);
    state_->insert_attempt(attempt);
    SQLite::Statement insert(state_->database,
                             "INSERT INTO layers (layer, attempt_id, bytes, committed_at) "
                             "SELECT ?, id, ?, ? FROM attempts WHERE layer = ? AND attempt = ?");
    insert.bind(1, attempt.layer);
    insert.bind(2, static_cast<std::int64_t>(bytes));
    insert.bind(3, at);
    insert.bind(4, attempt.layer);
    insert.bind(5, attempt.attempt);
    insert.exec();
    transaction.commit();
  });
}

JournalSummary LayerJournal::summary() const {
  return with_journal(state_->path, [&] { return summary_of(state_->database, state_->path); });
}

}  // namespace biotomy::acquisition
