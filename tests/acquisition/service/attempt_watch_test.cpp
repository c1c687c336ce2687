#include "acquisition/service/attempt_watch.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

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

/// Whether this process locks a byte of a file. A process is never told of its own locks: a child
/// asks.
bool is_locked(const std::filesystem::path& file, off_t byte) {
  const pid_t child = ::fork();
  if (child == 0) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
    struct flock lock {};
    lock.l_type = F_WRLCK;
    lock.l_start = byte;
    lock.l_len = 1;
    const bool asked = descriptor >= 0 && ::fcntl(descriptor, F_GETLK, &lock) == 0;
    ::_exit(asked && lock.l_type != F_UNLCK ? 1 : 0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WEXITSTATUS(status) == 1;
}

TEST_F(AttemptWatchTest, LeavesTheWritersLocksOnTheJournalAlone) {
  constexpr off_t kInUse = 128;  // of the index; "WAL-Index Format" of SQLite's documentation
  const std::filesystem::path index = path.string() + "-shm";
  LayerJournal journal(path);
  record(journal, 1);
  AttemptWatch watch(path);
  record(journal, 2);
  ASSERT_TRUE(is_locked(index, kInUse));
  EXPECT_EQ(watch.look().size(), 1U);
  EXPECT_TRUE(is_locked(index, kInUse));
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
