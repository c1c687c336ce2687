#include "acquisition/records/journal_reader.hpp"

#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include <SQLiteCpp/SQLiteCpp.h>
#include <nlohmann/json.hpp>

#include "acquisition/records/journal_error.hpp"
#include "acquisition/records/journal_schema.hpp"
#include "acquisition/records/journal_summary.hpp"

namespace biotomy::acquisition {
namespace {

constexpr int kBusyTimeoutMs = 2000;

std::vector<Metric> metrics_of(const std::string& text) {
  std::vector<Metric> metrics;
  for (const nlohmann::json& entry : nlohmann::json::parse(text)) {
    // JSON has no word for what is no number; a version before this one wrote null.
    if (!entry.at("value").is_number() || !entry.at("limit").is_number()) continue;
    metrics.push_back({entry.at("name").get<std::string>(), entry.at("value").get<double>(),
                       entry.at("limit").get<double>(), entry.at("passed").get<bool>()});
  }
  return metrics;
}

constexpr const char* kSelectAttempts =
    "SELECT id, layer, attempt, taken_at, exposure_us, gain, column_um, verdict, slug, reason, "
    "file, metrics FROM attempts ";

std::vector<AttemptNote> notes_of(SQLite::Statement& select) {
  std::vector<AttemptNote> notes;
  while (select.executeStep()) {
    notes.push_back({.id = select.getColumn(0).getInt64(),
                     .layer = select.getColumn(1).getInt64(),
                     .attempt = select.getColumn(2).getInt(),
                     .taken_at = select.getColumn(3).getString(),
                     .exposure_us = select.getColumn(4).getInt64(),
                     .gain = select.getColumn(5).getDouble(),
                     .column = bridge::Micrometres{select.getColumn(6).getDouble()},
                     .verdict = select.getColumn(7).getString(),
                     .slug = select.getColumn(8).getString(),
                     .reason = select.getColumn(9).getString(),
                     .file = select.getColumn(10).getString(),
                     .metrics = metrics_of(select.getColumn(11).getString())});
  }
  return notes;
}

constexpr const char* kGaveNoLayer = "verdict IN ('rejected', 'not_stored')";

/// The object of a metric in an attempt's list of them; nothing where it has none of that name. A
/// journal of 10000 layers holds some 20 MB of metrics, of which a chart wants a few: the others
/// are passed over unread. Metrics are objects of plain values, written without blanks by
/// LayerJournal.
std::optional<nlohmann::json> metric_in(std::string_view list, const std::string& name) {
  const std::string wanted = "\"name\":" + nlohmann::json(name).dump();
  const auto* const found =
      static_cast<const char*>(::memmem(list.data(), list.size(), wanted.data(), wanted.size()));
  if (found == nullptr) return std::nullopt;
  const auto place = static_cast<std::size_t>(found - list.data());
  const std::size_t begin = list.rfind('{', place);
  const std::size_t end = list.find('}', place);
  if (begin == std::string_view::npos || end == std::string_view::npos) return std::nullopt;
  return nlohmann::json::parse(list.substr(begin, end + 1 - begin));
}

std::optional<double> number_of(const nlohmann::json& metric, const char* key) {
  const auto found = metric.find(key);
  if (found == metric.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

/// A daemon that was killed left what is not in the journal's file yet.
bool has_unfinished_writes(const std::filesystem::path& journal) {
  std::error_code error;
  return std::filesystem::file_size(journal.string() + "-wal", error) > 0 && !error;
}

/// The file for SQLite as one that nobody writes: it makes no files beside it.
std::string name_of_unchanging(const std::filesystem::path& journal) {
  std::string name = "file:";
  for (const char character : std::filesystem::absolute(journal).string()) {
    switch (character) {
      case '%':
        name += "%25";
        break;
      case '?':
        name += "%3f";
        break;
      case '#':
        name += "%23";
        break;
      default:
        name += character;
    }
  }
  return name + "?immutable=1";
}

template <typename Work>
auto with_journal(const std::filesystem::path& path, Work work) {
  try {
    return work();
  } catch (const SQLite::Exception& error) {
    throw JournalError("the journal " + path.string() + ": " + error.what());
  } catch (const nlohmann::json::exception& error) {
    throw JournalError("the journal " + path.string() +
                       " holds metrics that are not JSON: " + error.what());
  }
}

}  // namespace

struct JournalReader::State {
  std::filesystem::path path;
  SQLite::Database database;

  State(const std::filesystem::path& journal_path, const std::string& name)
      : path(journal_path),
        database(name, SQLite::OPEN_READONLY | SQLite::OPEN_URI, kBusyTimeoutMs) {
    check_journal_version(database, journal_path);
  }
};

JournalReader::JournalReader(const std::filesystem::path& path, Journal is)
    : state_(with_journal(path, [&] {
        const bool leave_no_trace = is == Journal::at_rest && !has_unfinished_writes(path);
        return std::make_unique<State>(path,
                                       leave_no_trace ? name_of_unchanging(path) : path.string());
      })) {}

JournalReader::~JournalReader() = default;

std::vector<LayerRow> JournalReader::committed_layers(std::int64_t from, std::int64_t limit) const {
  return with_journal(state_->path, [&] {
    SQLite::Statement select(
        state_->database,
        "SELECT layers.layer, attempt, verdict, file, bytes, sha256, committed_at, reason, metrics "
        "FROM layers JOIN attempts ON attempts.id = layers.attempt_id "
        "WHERE layers.layer >= ? ORDER BY layers.layer LIMIT ?");
    select.bind(1, from);
    select.bind(2, limit);
    std::vector<LayerRow> rows;
    while (select.executeStep()) {
      rows.push_back(
          {.layer = select.getColumn(0).getInt64(),
           .attempt = select.getColumn(1).getInt(),
           .flagged = select.getColumn(2).getString() == to_string(Verdict::accepted_with_flag),
           .file = select.getColumn(3).getString(),
           .bytes = static_cast<std::uint64_t>(select.getColumn(4).getInt64()),
           .sha256 = select.getColumn(5).getString(),
           .committed_at = select.getColumn(6).getString(),
           .reason = select.getColumn(7).getString(),
           .metrics = metrics_of(select.getColumn(8).getString())});
    }
    return rows;
  });
}

std::vector<AttemptNote> JournalReader::attempts(std::int64_t layer) const {
  return with_journal(state_->path, [&] {
    SQLite::Statement select(state_->database,
                             std::string(kSelectAttempts) + "WHERE layer = ? ORDER BY attempt");
    select.bind(1, layer);
    return notes_of(select);
  });
}

std::vector<AttemptNote> JournalReader::attempts_after(std::int64_t id, std::int64_t limit) const {
  return with_journal(state_->path, [&] {
    SQLite::Statement select(state_->database,
                             std::string(kSelectAttempts) + "WHERE id > ? ORDER BY id LIMIT ?");
    select.bind(1, id);
    select.bind(2, limit);
    return notes_of(select);
  });
}

std::int64_t JournalReader::last_attempt_id() const {
  return with_journal(state_->path, [&] {
    return state_->database.execAndGet("SELECT coalesce(max(id), 0) FROM attempts").getInt64();
  });
}

std::vector<AttemptNote> JournalReader::rejected_before(std::int64_t before,
                                                        std::int64_t limit) const {
  return with_journal(state_->path, [&] {
    SQLite::Statement select(state_->database, std::string(kSelectAttempts) + "WHERE id < ? AND " +
                                                   kGaveNoLayer + " ORDER BY id DESC LIMIT ?");
    select.bind(1, before);
    select.bind(2, limit);
    return notes_of(select);
  });
}

std::int64_t JournalReader::rejected_count() const {
  return with_journal(state_->path, [&] {
    return state_->database
        .execAndGet(std::string("SELECT count(*) FROM attempts WHERE ") + kGaveNoLayer)
        .getInt64();
  });
}

bool JournalReader::names_file(const std::string& file) const {
  return with_journal(state_->path, [&] {
    SQLite::Statement select(state_->database, "SELECT 1 FROM attempts WHERE file = ? LIMIT 1");
    select.bind(1, file);
    return select.executeStep();
  });
}

AttemptHistory JournalReader::history(const std::vector<std::string>& metrics,
                                      std::int64_t after) const {
  return with_journal(state_->path, [&] {
    AttemptHistory history;
    for (const std::string& name : metrics) history.metrics.push_back({name, {}, {}});
    SQLite::Statement select(state_->database,
                             "SELECT id, layer, attempt, verdict, column_um, taken_at, metrics "
                             "FROM attempts WHERE id > ? ORDER BY id");
    select.bind(1, after);
    while (select.executeStep()) {
      history.id.push_back(select.getColumn(0).getInt64());
      history.layer.push_back(select.getColumn(1).getInt64());
      history.attempt.push_back(select.getColumn(2).getInt());
      history.verdict.push_back(select.getColumn(3).getString());
      history.column_um.push_back(select.getColumn(4).getDouble());
      history.taken_at.push_back(select.getColumn(5).getString());
      const SQLite::Column text = select.getColumn(6);
      const std::string_view list(text.getText(), static_cast<std::size_t>(text.getBytes()));
      for (AttemptHistory::Column& column : history.metrics) {
        const auto metric = metric_in(list, column.name);
        column.value.push_back(metric ? number_of(*metric, "value") : std::nullopt);
        column.limit.push_back(metric ? number_of(*metric, "limit") : std::nullopt);
      }
    }
    return history;
  });
}

std::int64_t JournalReader::committed_count() const {
  return with_journal(state_->path, [&] {
    return state_->database.execAndGet("SELECT count(*) FROM layers").getInt64();
  });
}

std::vector<std::int64_t> JournalReader::starts() const {
  return with_journal(state_->path, [&] {
    SQLite::Statement select(
        state_->database,
        "SELECT CAST(substr(text, length(?1) + 1) AS INTEGER) FROM events "
        "WHERE kind = 'recovery' AND substr(text, 1, length(?1)) = ?1 ORDER BY id");
    select.bind(1, std::string(kGoesOnWithLayer));
    std::vector<std::int64_t> layers;
    while (select.executeStep()) layers.push_back(select.getColumn(0).getInt64());
    return layers;
  });
}

JournalSummary JournalReader::summary() const {
  return with_journal(state_->path, [&] { return summary_of(state_->database, state_->path); });
}

std::uint32_t JournalReader::last_sequence() const {
  return with_journal(state_->path, [&] {
    return static_cast<std::uint32_t>(
        state_->database.execAndGet("SELECT coalesce(max(sequence), 0) FROM grinds").getInt64());
  });
}

std::string JournalReader::last_state() const {
  return with_journal(state_->path, [&] {
    return state_->database
        .execAndGet(
            "SELECT coalesce((SELECT iif(kind = 'alarm', 'faulted', state) FROM events WHERE kind "
            "IN ('state', 'alarm') "
            "ORDER BY id DESC LIMIT 1), '')")
        .getString();
  });
}

// An acknowledgement, like all that goes on after it, is a state that is not `faulted`.
std::string JournalReader::standing_alarm() const {
  return with_journal(state_->path, [&] {
    return state_->database
        .execAndGet(
            "SELECT coalesce((SELECT text FROM events WHERE kind = 'alarm' AND id > coalesce("
            "(SELECT max(id) FROM events WHERE kind = 'state' AND state <> 'faulted'), 0) "
            "ORDER BY id LIMIT 1), '')")
        .getString();
  });
}

}  // namespace biotomy::acquisition
