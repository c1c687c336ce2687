#include "tests/faults/recorded_disk.hpp"

#include <fstream>
#include <set>

#include <gmock/gmock.h>

#include "tests/faults/folder_content.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using testing::AnyOf;
using testing::IsEmpty;
using testing::Pair;
using testing::UnorderedElementsAre;

/// A log as disk_recorder.cpp writes it, call by call.
class WrittenLog {
 public:
  explicit WrittenLog(const std::filesystem::path& path) : out_(path, std::ios::binary) {
    add({.call = DiskCall::start});
  }

  void create(std::uint64_t node, const std::string& path) {
    add({.call = DiskCall::create, .node = node}, path);
  }
  void write(std::uint64_t node, std::uint64_t offset, const std::string& data) {
    add({.call = DiskCall::write, .node = node, .offset = offset, .data_size = data.size()}, "", "",
        data);
  }
  void truncate(std::uint64_t node, std::uint64_t size) {
    add({.call = DiskCall::truncate, .node = node, .offset = size});
  }
  /// Of a file by its number, of a folder by its path. It began before the last `late` calls.
  void sync(std::uint64_t node, const std::string& path, std::uint64_t late = 0) {
    add({.call = DiskCall::sync, .node = node, .offset = count_ - late}, path);
  }
  void fail_to_sync(std::uint64_t node, const std::string& path) {
    add({.call = DiskCall::failed_sync, .node = node, .offset = count_}, path);
  }
  void rename(std::uint64_t node, const std::string& from, const std::string& to) {
    add({.call = DiskCall::rename, .node = node}, from, to);
  }
  void remove(const std::string& path) { add({.call = DiskCall::remove}, path); }
  void make_folder(const std::string& path) { add({.call = DiskCall::make_folder}, path); }

  void flush() { out_.flush(); }

 private:
  void add(DiskRecord record, const std::string& path = "", const std::string& to = "",
           const std::string& data = "") {
    record.path_size = static_cast<std::uint32_t>(path.size());
    record.to_size = static_cast<std::uint32_t>(to.size());
    out_.write(reinterpret_cast<const char*>(&record), sizeof record);
    out_ << path << to << data;
    ++count_;
  }

  std::ofstream out_;
  std::uint64_t count_ = 0;
};

constexpr std::uint64_t kRoot = 1;
constexpr std::uint64_t kFile = 7;

class DiskAfterACut : public testing::Test {
 protected:
  RecordedDisk disk() {
    log_.flush();
    return RecordedDisk(folder_ / "log");
  }

  FolderContent state(const RecordedDisk& disk, std::size_t cut, PowerLoss loss) {
    const auto place = folder_ / ("state" + std::to_string(states_++));
    disk.write_state(cut, loss, random_, place);
    return content_of_folder(place);
  }
  FolderContent at_the_end(PowerLoss loss) {
    const RecordedDisk recorded = disk();
    return state(recorded, recorded.calls().size(), loss);
  }

  TemporaryFolder folder_;
  WrittenLog log_{folder_ / "log"};
  std::mt19937 random_{1};
  int states_ = 0;
};

TEST_F(DiskAfterACut, HoldsASyncedFileOnlyWhenItsNameIsSyncedToo) {
  log_.create(kFile, "a");
  log_.write(kFile, 0, "abc");
  log_.sync(kFile, "a");
  EXPECT_THAT(at_the_end(PowerLoss::everything), IsEmpty());
  log_.sync(kRoot, "");
  EXPECT_THAT(at_the_end(PowerLoss::everything), UnorderedElementsAre(Pair("a", "abc")));
}

TEST_F(DiskAfterACut, LosesWhatWasWrittenSinceTheSync) {
  log_.create(kFile, "a");
  log_.write(kFile, 0, "abc");
  log_.sync(kFile, "a");
  log_.sync(kRoot, "");
  log_.write(kFile, 3, "def");
  EXPECT_THAT(at_the_end(PowerLoss::everything), UnorderedElementsAre(Pair("a", "abc")));
  EXPECT_THAT(at_the_end(PowerLoss::nothing), UnorderedElementsAre(Pair("a", "abcdef")));
  EXPECT_THAT(at_the_end(PowerLoss::data),
              UnorderedElementsAre(Pair("a", std::string("abc\0\0\0", 6))));
  std::set<std::string> seen;
  for (int i = 0; i < 60; ++i) seen.insert(at_the_end(PowerLoss::random).at("a"));
  EXPECT_THAT(seen, UnorderedElementsAre("abc", "abcdef", std::string("abc\0\0\0", 6)));
}

TEST_F(DiskAfterACut, HoldsNothingOfWhatBeganAfterTheSyncDid) {
  log_.create(kFile, "a");
  log_.sync(kRoot, "");
  log_.write(kFile, 0, "abc");
  log_.sync(kFile, "a", 1);  // the write came while the sync was under way
  EXPECT_THAT(at_the_end(PowerLoss::everything), UnorderedElementsAre(Pair("a", "")));
}

TEST_F(DiskAfterACut, HoldsTheOldOrTheNewBehindARename) {
  log_.create(kFile, "a");
  log_.write(kFile, 0, "old");
  log_.sync(kFile, "a");
  log_.create(8, ".a");
  log_.sync(kRoot, "");
  log_.write(8, 0, "new");
  log_.sync(8, ".a");
  log_.rename(8, ".a", "a");
  EXPECT_THAT(at_the_end(PowerLoss::everything),
              UnorderedElementsAre(Pair("a", "old"), Pair(".a", "new")));
  for (int i = 0; i < 20; ++i) {
    EXPECT_THAT(at_the_end(PowerLoss::random).at("a"), AnyOf("old", "new"));
  }
  log_.sync(kRoot, "");
  EXPECT_THAT(at_the_end(PowerLoss::everything), UnorderedElementsAre(Pair("a", "new")));
}

TEST_F(DiskAfterACut, HoldsFoldersAndShorterFilesOnceTheyAreSynced) {
  log_.make_folder("layers");
  log_.create(kFile, "layers/a");
  log_.write(kFile, 0, "abcdef");
  log_.sync(kFile, "layers/a");
  log_.sync(2, "layers");
  EXPECT_THAT(at_the_end(PowerLoss::everything), IsEmpty());
  log_.sync(kRoot, "");
  log_.truncate(kFile, 2);
  EXPECT_THAT(at_the_end(PowerLoss::everything), UnorderedElementsAre(Pair("layers/a", "abcdef")));
  log_.sync(kFile, "layers/a");
  log_.remove("layers/a");
  EXPECT_THAT(at_the_end(PowerLoss::everything), UnorderedElementsAre(Pair("layers/a", "ab")));
  EXPECT_THAT(at_the_end(PowerLoss::nothing), IsEmpty());
}

TEST_F(DiskAfterACut, TearsALargeWriteSectorBySector) {
  log_.create(kFile, "a");
  log_.sync(kRoot, "");
  log_.write(kFile, 0, std::string(512 * 8, 'x'));
  bool torn = false;
  for (int i = 0; i < 60; ++i) {
    const std::string bytes = at_the_end(PowerLoss::random).at("a");
    torn = torn || (bytes.find('x') != std::string::npos && bytes.find('\0') != std::string::npos);
  }
  EXPECT_TRUE(torn);
}

TEST_F(DiskAfterACut, IsAsIfASyncThatIsTakenAwayHadNotBeen) {
  log_.create(kFile, "a");
  log_.sync(kRoot, "");
  log_.write(kFile, 0, "abc");
  log_.sync(kFile, "a");  // call 4
  log_.write(kFile, 3, "d");
  log_.sync(kFile, "a");  // call 6
  const RecordedDisk without = disk().without_sync(4);
  EXPECT_THAT(state(without, 6, PowerLoss::everything), UnorderedElementsAre(Pair("a", "")));
  EXPECT_THAT(state(without, 7, PowerLoss::everything), UnorderedElementsAre(Pair("a", "abcd")));
  EXPECT_THROW(static_cast<void>(disk().without_sync(3)), std::runtime_error);
}

TEST_F(DiskAfterACut, TellsAFileFromAnOlderOneOfTheSameNumber) {
  log_.create(kFile, "a");
  log_.write(kFile, 0, "of a");
  log_.remove("a");
  log_.create(kFile, "b");
  log_.write(kFile, 0, "b");
  EXPECT_THAT(at_the_end(PowerLoss::nothing), UnorderedElementsAre(Pair("b", "b")));
}

TEST_F(DiskAfterACut, NeverHoldsWhatAFailedSyncShouldHaveWritten) {
  log_.create(kFile, "a");
  log_.sync(kRoot, "");
  log_.write(kFile, 0, "abc");
  log_.fail_to_sync(kFile, "a");
  log_.write(kFile, 3, "d");
  log_.sync(kFile, "a");
  EXPECT_THAT(at_the_end(PowerLoss::everything),
              UnorderedElementsAre(Pair("a", std::string("\0\0\0d", 4))));
  log_.write(kFile, 0, "abc");
  log_.sync(kFile, "a");
  EXPECT_THAT(at_the_end(PowerLoss::everything), UnorderedElementsAre(Pair("a", "abcd")));
}

TEST_F(DiskAfterACut, IsRefusedFromALogThatIsCutOff) {
  log_.create(kFile, "a");
  log_.flush();
  std::filesystem::resize_file(folder_ / "log", std::filesystem::file_size(folder_ / "log") - 1);
  EXPECT_THROW(RecordedDisk(folder_ / "log"), std::runtime_error);
}

}  // namespace
}  // namespace biotomy::tests
