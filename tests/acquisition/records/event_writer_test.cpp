#include "acquisition/records/event_writer.hpp"

#include <gmock/gmock.h>

#include "acquisition/records/journal_reader.hpp"
#include "acquisition/records/layer_journal.hpp"
#include "tests/acquisition/fake_rig.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;
using testing::Optional;

struct EventWriterTest : testing::Test {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "journal.sqlite";
  InlineWorker worker;

  static JobEventRow state(const std::string& name) {
    return {.kind = "state", .state = name, .layer = 0, .text = "", .at = "2026-11-01T00:00:00Z"};
  }
};

TEST_F(EventWriterTest, WritesBesideTheOneWhoWritesLayers) {
  LayerJournal journal(path);
  EventWriter events(worker, path);
  events.post(state("homing"));
  AttemptRow row;
  row.layer = row.attempt = 1;
  journal.commit_layer(row, 5, "2026-11-01T00:00:00Z");
  events.post(state("paused"));
  EXPECT_EQ(JournalReader(path).last_state(), "paused");
  EXPECT_EQ(JournalReader(path).committed_count(), 1);
  EXPECT_EQ(events.failure(), std::nullopt);
}

TEST_F(EventWriterTest, TellsForEverThatAnEventWasNotWritten) {
  std::filesystem::create_directory(path);
  EventWriter events(worker, path);
  EXPECT_EQ(events.failure(), std::nullopt);
  events.post(state("homing"));
  EXPECT_THAT(events.failure(), Optional(HasSubstr(path.string())));
  std::filesystem::remove(path);
  const LayerJournal journal(path);
  events.post(state("paused"));
  EXPECT_THAT(events.failure(), Optional(HasSubstr(path.string())));
}

TEST_F(EventWriterTest, ClosesTheJournalByItsWorker) {
  { const LayerJournal made(path); }
  HeldWorker held;
  {
    EventWriter events(held, path);
    events.post(state("homing"));
  }
  EXPECT_EQ(JournalReader(path).last_state(), "");
  held.run();
  EXPECT_EQ(JournalReader(path, JournalReader::Journal::at_rest).last_state(), "homing");
  EXPECT_FALSE(std::filesystem::exists(path.string() + "-wal"));
}

}  // namespace
}  // namespace biotomy::tests
