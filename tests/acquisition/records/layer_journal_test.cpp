#include "acquisition/records/layer_journal.hpp"

#include <chrono>
#include <cmath>
#include <fstream>
#include <optional>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/records/journal_error.hpp"
#include "acquisition/records/journal_reader.hpp"
#include "acquisition/records/journal_schema.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr const char* kAt = "2026-11-22T03:04:05.678Z";

AttemptRow attempt(std::int64_t layer, int number, Verdict verdict) {
  AttemptRow row;
  row.layer = layer;
  row.attempt = number;
  row.taken_at = kAt;
  row.assessment.verdict = verdict;
  row.assessment.slug = "good";
  row.assessment.reason = "every metric is within its limit";
  row.assessment.metrics = {{"sharpness_ratio", 0.93, 0.7, true}};
  row.file = "layers/000001.tif";
  row.sha256 = "abc";
  return row;
}

struct LayerJournalTest : testing::Test {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "journal.sqlite";
};

TEST_F(LayerJournalTest, WritesAnewWhatOnlyItsLogHolds) {
  LayerJournal journal(path);
  journal.commit_layer(attempt(1, 1, Verdict::accepted), 42, kAt);
  const std::filesystem::path other = folder.path() / "other.sqlite";
  std::filesystem::copy_file(path, other);
  std::filesystem::copy_file(path.string() + "-wal", other.string() + "-wal");
  {
    const LayerJournal opened(other);
    EXPECT_EQ(std::filesystem::file_size(other.string() + "-wal"), 0U);
    std::filesystem::copy_file(other, folder.path() / "database-alone.sqlite");
  }
  EXPECT_EQ(LayerJournal(folder.path() / "database-alone.sqlite").summary().last_committed, 1);
}

TEST_F(LayerJournalTest, WaitsWhileItsLogIsMovedByAnother) {
  LayerJournal{path};
  const auto opened = [&] {
    return SQLite::Database(path.string(), SQLite::OPEN_READWRITE, 10000);
  };
  SQLite::Database reader = opened();
  std::optional<SQLite::Transaction> reading(std::in_place, reader);
  reader.execAndGet("SELECT count(*) FROM layers");
  SQLite::Database writer = opened();
  writer.exec("INSERT INTO events (at, kind, state, layer, text) VALUES ('', 'state', '', 1, '')");
  // Its checkpoint waits for the reader, and no other can begin meanwhile.
  const std::jthread mover([&](const std::stop_token& stop) {
    const char* const move = "PRAGMA wal_checkpoint(TRUNCATE)";
    while (!stop.stop_requested() && writer.execAndGet(move).getInt() != 0) {
    }
  });
  SQLite::Database other = opened();
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (other.execAndGet("PRAGMA wal_checkpoint(PASSIVE)").getInt() == 0) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "nobody moves the log";
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  // Long enough for the journal to be opened in vain at first.
  const std::jthread leaver([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    reading.reset();
  });
  EXPECT_NO_THROW(LayerJournal{path});
}

TEST_F(LayerJournalTest, RemembersAcrossARestart) {
  {
    LayerJournal journal(path);
    journal.begin_grind({.sequence = 17,
                         .layer = 1,
                         .target = {1000.0},
                         .ground_before = {900.0},
                         .count_before = 3,
                         .finished = false},
                        kAt);
    journal.end_grind(17, bridge::CommandResult::done, {}, kAt);
    journal.record_focus({.layer = 1,
                          .why = "first",
                          .column = {612.5},
                          .sharpness = 0.4,
                          .found = true,
                          .points = {{{600.0}, 0.3}},
                          .lean = FaceLean{{12.5}, {-3.0}, 0.1, 80}},
                         kAt);
    journal.record_attempt(attempt(1, 1, Verdict::rejected));
    journal.commit_layer(attempt(1, 2, Verdict::accepted), 1234, kAt);
    journal.record_attempt(attempt(2, 1, Verdict::rejected));
  }
  const JournalSummary summary = LayerJournal(path).summary();
  EXPECT_EQ(summary.last_committed, 1);
  EXPECT_EQ(summary.last_attempt, 1);
  EXPECT_EQ(summary.last_sequence, 17U);
  EXPECT_EQ(summary.last_layer_bytes, 1234U);
  ASSERT_TRUE(summary.last_grind);
  EXPECT_TRUE(summary.last_grind->finished);
  EXPECT_EQ(summary.last_grind->count_before, 3);
  ASSERT_TRUE(summary.last_focus);
  EXPECT_EQ(summary.last_focus->column.value, 612.5);
}

TEST_F(LayerJournalTest, RemembersTheLastFocusThatLedToAStoredLayer) {
  LayerJournal journal(path);
  const auto search = [&](std::int64_t layer, double column_um, bool found) {
    FocusRow row{.layer = layer, .why = "", .column = {column_um}, .found = found, .points = {}};
    journal.record_focus(row, kAt);
  };
  const auto known = [&] {
    const auto focus = journal.summary().last_focus;
    return focus ? focus->column.value : 0.0;
  };
  search(1, 500.0, true);
  search(1, 510.0, true);
  EXPECT_EQ(known(), 0.0);
  EXPECT_TRUE(journal.summary().focus_in_doubt);
  journal.commit_layer(attempt(1, 1, Verdict::accepted), 1, kAt);
  EXPECT_EQ(known(), 510.0);
  EXPECT_FALSE(journal.summary().focus_in_doubt);

  search(2, 900.0, true);
  search(2, 530.0, false);  // then the focus was followed
  journal.commit_layer(attempt(2, 1, Verdict::accepted), 1, kAt);
  EXPECT_EQ(known(), 510.0);

  search(3, 910.0, true);
  journal.record_attempt(attempt(3, 1, Verdict::rejected));
  EXPECT_EQ(known(), 510.0);
  EXPECT_TRUE(journal.summary().focus_in_doubt);
  journal.commit_layer(attempt(3, 2, Verdict::accepted_with_flag), 1, kAt);
  EXPECT_EQ(known(), 910.0);

  search(4, 550.0, true);
  journal.record_attempt(attempt(4, 2, Verdict::rejected));
  journal.commit_layer(attempt(4, 1, Verdict::accepted_with_flag), 1, kAt);
  EXPECT_EQ(known(), 910.0) << "the frame may have been taken before the search";
}

TEST_F(LayerJournalTest, CountsTheLastLayersThatHaveAFlag) {
  LayerJournal journal(path);
  const auto commit = [&](std::int64_t layer, Verdict verdict) {
    journal.commit_layer(attempt(layer, 1, verdict), 1, kAt);
    return journal.summary().flagged_in_a_row;
  };
  EXPECT_EQ(journal.summary().flagged_in_a_row, 0);
  EXPECT_EQ(commit(1, Verdict::accepted_with_flag), 1);
  EXPECT_EQ(commit(2, Verdict::accepted), 0);
  EXPECT_EQ(commit(3, Verdict::accepted_with_flag), 1);
  EXPECT_EQ(commit(4, Verdict::accepted_with_flag), 2);
}

TEST_F(LayerJournalTest, WritesDownHowTheFaceLeans) {
  LayerJournal journal(path);
  journal.record_focus(
      {.layer = 1, .why = "first", .points = {}, .lean = FaceLean{{12.5}, {-3.0}, 0.1, 80}}, kAt);
  journal.record_focus({.layer = 2, .why = "first", .points = {}}, kAt);
  SQLite::Database database(path.string());
  const auto count = [&](const std::string& where) {
    return database.execAndGet("SELECT count(*) FROM focus_sweeps WHERE " + where).getInt();
  };
  EXPECT_EQ(count("layer = 1 AND json_extract(lean, '$.across_um') = 12.5 AND "
                  "json_extract(lean, '$.tiles') = 80"),
            1);
  EXPECT_EQ(count("layer = 2 AND lean IS NULL"), 1);
}

TEST_F(LayerJournalTest, IsReadWhileItIsWritten) {
  LayerJournal journal(path);
  const JournalReader reader(path);
  EXPECT_EQ(reader.committed_count(), 0);
  journal.commit_layer(attempt(1, 1, Verdict::accepted_with_flag), 99, kAt);
  const std::vector<LayerRow> rows = reader.committed_layers(1, 10);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_TRUE(rows[0].flagged);
  EXPECT_EQ(rows[0].bytes, 99U);
  EXPECT_EQ(rows[0].committed_at, kAt);
  ASSERT_EQ(rows[0].metrics.size(), 1U);
  EXPECT_EQ(rows[0].metrics[0].name, "sharpness_ratio");
}

TEST_F(LayerJournalTest, ShowsTheAttemptsSinceTheOneThatIsKnown) {
  LayerJournal journal(path);
  const JournalReader reader(path);
  EXPECT_EQ(reader.last_attempt_id(), 0);
  EXPECT_TRUE(reader.attempts_after(0, 10).empty());
  AttemptRow first = attempt(7, 1, Verdict::rejected);
  first.column = bridge::Micrometres{612.5};
  first.exposure_us = 8000;
  first.gain = 1.5;
  journal.record_attempt(first);
  journal.commit_layer(attempt(7, 2, Verdict::accepted), 99, kAt);
  journal.record_attempt(attempt(8, 1, Verdict::rejected));

  const std::vector<AttemptNote> all = reader.attempts_after(0, 2);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].layer, 7);
  EXPECT_EQ(all[0].slug, "good");
  EXPECT_EQ(all[0].column.value, 612.5);
  EXPECT_EQ(all[0].exposure_us, 8000);
  EXPECT_EQ(all[0].gain, 1.5);
  EXPECT_EQ(all[1].attempt, 2);
  const std::vector<AttemptNote> rest = reader.attempts_after(all[1].id, 10);
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_EQ(rest[0].layer, 8);
  EXPECT_EQ(reader.last_attempt_id(), rest[0].id);
}

TEST_F(LayerJournalTest, ShowsAttemptsWithAMetricThatIsNoNumber) {
  LayerJournal journal(path);
  AttemptRow row = attempt(1, 1, Verdict::rejected);
  row.assessment.metrics = {{"sharpness", 2.0, 1.0, true}, {"drift", std::nan(""), 0.1, false}};
  journal.record_attempt(row);
  const std::vector<AttemptNote> notes = JournalReader(path).attempts_after(0, 10);
  ASSERT_EQ(notes.size(), 1U);
  ASSERT_EQ(notes[0].metrics.size(), 1U);
  EXPECT_EQ(notes[0].metrics[0].name, "sharpness");
}

TEST_F(LayerJournalTest, CommitsALayerOnlyOnce) {
  LayerJournal journal(path);
  journal.commit_layer(attempt(1, 1, Verdict::accepted), 99, kAt);
  EXPECT_THROW(journal.commit_layer(attempt(1, 2, Verdict::accepted), 99, kAt), JournalError);
  // Both rows or neither: the second attempt is not there.
  SQLite::Database database(path.string());
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM attempts").getInt(), 1);
}

TEST_F(LayerJournalTest, KeepsOneNumberForOneGrind) {
  LayerJournal journal(path);
  const GrindRow grind{.sequence = 5,
                       .layer = 1,
                       .target = {1.0},
                       .ground_before = {0.0},
                       .count_before = 0,
                       .finished = false};
  journal.begin_grind(grind, kAt);
  EXPECT_THROW(journal.begin_grind(grind, kAt), JournalError);
}

TEST_F(LayerJournalTest, IsWrittenAheadAndFullySynchronous) {
  const LayerJournal journal(path);
  SQLite::Database database(path.string());
  EXPECT_EQ(database.execAndGet("PRAGMA journal_mode").getString(), "wal");
  EXPECT_EQ(database.execAndGet("PRAGMA user_version").getInt(), journal_version());
}

TEST_F(LayerJournalTest, IsMadeAnewWhereAMakerWasKilled) {
  std::ofstream(folder.path() / ".journal.sqlite.new") << "half";
  std::ofstream(folder.path() / ".journal.sqlite.new-wal") << "of it";
  { const LayerJournal journal(path); }
  EXPECT_EQ(JournalReader(path).committed_count(), 0);
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    names.push_back(entry.path().filename());
  }
  EXPECT_THAT(names, testing::Each(testing::StartsWith("journal.sqlite")));
}

TEST_F(LayerJournalTest, RefusesAJournalOfANewerProgram) {
  {
    SQLite::Database database(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    database.exec("PRAGMA user_version = 99");
  }
  EXPECT_THAT([&] { const LayerJournal journal(path); },
              ThrowsMessage<JournalError>(HasSubstr("use the newer program")));
}

TEST_F(LayerJournalTest, RefusesAFileThatIsNoJournal) {
  std::ofstream(path) << std::string(5000, 'x');
  EXPECT_THAT([&] { const LayerJournal journal(path); },
              ThrowsMessage<JournalError>(HasSubstr("not a database")));
}

}  // namespace
}  // namespace biotomy::tests
