#include "reconstruct/store/local_object_reader.hpp"

#include <gmock/gmock.h>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::TemporaryFolder;

std::string read_text(ObjectReader& reader, const std::string& name, const ObjectVersion& version,
                      std::uint64_t offset, std::size_t length) {
  std::string text(length, ' ');
  reader.read(name, version, offset, std::as_writable_bytes(std::span(text)));
  return text;
}

TEST(LocalObjectReader, ReadsARangeOfANamedObject) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "c");
  write_text(folder.path() / "c" / "0", "0123456789");
  LocalObjectReader reader(folder.path());
  const auto version = reader.version("c/0");
  ASSERT_TRUE(version);
  EXPECT_EQ(version->size, 10U);
  EXPECT_EQ(read_text(reader, "c/0", *version, 3, 4), "3456");
}

TEST(LocalObjectReader, HasNoVersionOfWhatIsNotThere) {
  const TemporaryFolder folder;
  write_text(folder.path() / "file", "x");
  LocalObjectReader reader(folder.path());
  EXPECT_FALSE(reader.version("missing"));
  EXPECT_FALSE(reader.version("file/below"));
}

TEST(LocalObjectReader, SaysWhereAnObjectEnds) {
  const TemporaryFolder folder;
  write_text(folder.path() / "a", "0123456789");
  LocalObjectReader reader(folder.path());
  const auto version = *reader.version("a");
  EXPECT_THAT(message_of<SampleError>([&] { read_text(reader, "a", version, 8, 4); }),
              testing::HasSubstr("truncated"));
}

TEST(LocalObjectReader, LeavesWhatCannotBeAnnouncedToTheReading) {
  const TemporaryFolder folder;
  write_durably(folder.path() / "a", std::string("0123456789"));
  LocalObjectReader reader(folder.path());
  const auto version = *reader.version("a");
  reader.expect("a", version, 2, 4);
  reader.expect("a", version, 8, 1000);  // further than it goes
  EXPECT_EQ(read_text(reader, "a", version, 2, 4), "2345");
  LocalObjectReader other(folder.path());
  std::filesystem::remove(folder.path() / "a");
  EXPECT_NO_THROW(other.expect("a", version, 0, 4));
  EXPECT_THROW(read_text(other, "a", version, 0, 4), SampleError);
}

TEST(LocalObjectReader, TellsWhenAnObjectWasReplacedSinceItsVersionWasAskedFor) {
  const TemporaryFolder folder;
  write_durably(folder.path() / "a", std::string("old"));
  LocalObjectReader reader(folder.path());
  const auto before = *reader.version("a");
  write_durably(folder.path() / "a", std::string("newer"));
  EXPECT_THROW(read_text(reader, "a", before, 0, 3), ObjectReplaced);
  EXPECT_EQ(read_text(reader, "a", *reader.version("a"), 0, 5), "newer");
}

TEST(LocalObjectReader, KeepsOnReadingAVersionThatItHasOpenThoughItWasReplaced) {
  const TemporaryFolder folder;
  write_durably(folder.path() / "a", std::string("old"));
  LocalObjectReader reader(folder.path());
  const auto before = *reader.version("a");
  EXPECT_EQ(read_text(reader, "a", before, 0, 3), "old");
  write_durably(folder.path() / "a", std::string("newer"));
  EXPECT_EQ(read_text(reader, "a", before, 0, 3), "old");
}

TEST(LocalObjectReader, KeepsNoMoreFilesOpenThanItMay) {
  const TemporaryFolder folder;
  const auto open_descriptors = [] { return names_in("/proc/self/fd").size(); };
  LocalObjectReader reader(folder.path(), 4);
  const std::size_t before = open_descriptors();
  for (int i = 0; i < 20; ++i) {
    const std::string name = std::to_string(i);
    write_text(folder.path() / name, name);
    EXPECT_EQ(read_text(reader, name, *reader.version(name), 0, name.size()), name);
  }
  EXPECT_EQ(open_descriptors(), before + 4);
}

}  // namespace
}  // namespace biotomy::reconstruct
