#include "acquisition/service/attempt_watch.hpp"

#include <gtest/gtest.h>

#include "acquisition/records/layer_journal.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

struct AttemptWatchTest : testing::Test {
  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "journal.sqlite";

  static void record(LayerJournal& journal, std::int64_t layer, int attempt = 1) {
    AttemptRow row;
    row.layer = layer;
    row.attempt = attempt;
    journal.record_attempt(row);
  }
};

TEST_F(AttemptWatchTest, SeesWhatIsWrittenAfterItBegan) {
  LayerJournal journal(path);
  record(journal, 1);
  AttemptWatch watch(path);
  ASSERT_TRUE(watch.last());
  EXPECT_EQ(watch.last()->layer, 1);
  EXPECT_TRUE(watch.look().empty());
  record(journal, 2, 1);
  record(journal, 2, 2);
  const std::vector<AttemptNote> found = watch.look();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].attempt, 2);
  EXPECT_EQ(watch.last()->id, found[1].id);
  EXPECT_TRUE(watch.look().empty());
}

TEST_F(AttemptWatchTest, WaitsForAJournalToBeMade) {
  AttemptWatch watch(path);
  EXPECT_TRUE(watch.look().empty());
  EXPECT_FALSE(watch.last());
  LayerJournal journal(path);
  record(journal, 1);
  EXPECT_EQ(watch.look().size(), 1U);
}

TEST_F(AttemptWatchTest, ReadsMoreThanAThousandOneThousandAfterTheOther) {
  AttemptWatch watch(path);
  LayerJournal journal(path);
  for (int i = 1; i <= 1001; ++i) record(journal, i);
  EXPECT_EQ(watch.look().size(), 1000U);
  EXPECT_EQ(watch.look().size(), 1U);
}

TEST_F(AttemptWatchTest, SeesWhatWasWrittenBeforeALookAndCommittedAfterIt) {
  const std::filesystem::path log = path.string() + "-wal";
  const auto size_of_two = [&] {
    const std::filesystem::path other = folder.path() / "other.sqlite";
    LayerJournal journal(other);
    record(journal, 1);
    record(journal, 2);
    return std::filesystem::file_size(other.string() + "-wal");
  }();
  LayerJournal journal(path);
  record(journal, 1);
  AttemptWatch watch(path);
  // As it is while the disk takes its time: the log has the second attempt's bytes already.
  const auto size_of_one = std::filesystem::file_size(log);
  std::filesystem::resize_file(log, size_of_two);
  const auto written = std::filesystem::last_write_time(log);
  EXPECT_TRUE(watch.look().empty());
  std::filesystem::resize_file(log, size_of_one);
  record(journal, 2);
  ASSERT_EQ(std::filesystem::file_size(log), size_of_two);
  std::filesystem::last_write_time(log, written);
  EXPECT_EQ(watch.look().size(), 1U);
}

TEST_F(AttemptWatchTest, KnowsWhatSomebodyMissed) {
  EXPECT_TRUE(missed_attempts(path, 0, 0)->empty());
  LayerJournal journal(path);
  for (int i = 1; i <= 1005; ++i) record(journal, i);
  EXPECT_EQ(missed_attempts(path, 1000, 1003)->size(), 3U);
  EXPECT_TRUE(missed_attempts(path, 1005, 1005)->empty());
  EXPECT_EQ(missed_attempts(path, 5, 1005)->size(), 1000U);
  EXPECT_FALSE(missed_attempts(path, 4, 1005));     // too much to be told one by one
  EXPECT_FALSE(missed_attempts(path, 1006, 1005));  // of another journal
}

}  // namespace
}  // namespace biotomy::tests
