#include "reconstruct/disk/temporary_file.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <unistd.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using tests::TemporaryFolder;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

TEST(TemporaryFile, IsHiddenUntilItIsRenamed) {
  const TemporaryFolder folder;
  TemporaryFile file(folder.path() / "a");
  EXPECT_EQ(names_in(folder.path()).front().front(), '.');
  file.write(bytes_of("abc"));
  file.rename_to_target();
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a"));
}

TEST(TemporaryFile, BelongsToWhomItWasMovedTo) {
  const TemporaryFolder folder;
  {
    TemporaryFile first(folder.path() / "a");
    const TemporaryFile second(std::move(first));
    EXPECT_EQ(names_in(folder.path()).size(), 1U);
  }
  EXPECT_TRUE(names_in(folder.path()).empty());
}

class ReadingBack : public testing::Test {
 protected:
  std::string complaint_of(std::string_view expected) {
    return message_of<SampleError>([&] { file_.read_back(bytes_of(expected)); });
  }

  TemporaryFolder folder_;
  TemporaryFile file_{folder_.path() / "a"};
};

TEST_F(ReadingBack, NoticesEachWayToDiffer) {
  file_.write(bytes_of("abc"));
  for (const std::string_view other : {"abd", "ab", "abcd", ""}) {
    EXPECT_THAT(complaint_of(other), HasSubstr("a: what the disk gave back")) << other;
  }
  EXPECT_EQ(file_.read_back(bytes_of("abc")).size(), 64U);
}

TEST(TemporaryFile, TakesAnotherNameWhenOneWasLeftByAProcessOfTheSameNumber) {
  const TemporaryFolder folder;
  std::string name;
  {
    const TemporaryFile file(folder.path() / "a");
    name = names_in(folder.path()).front();
  }
  const std::size_t dash = name.rfind('-');
  const int number = std::stoi(name.substr(dash + 1));
  std::ofstream(folder.path() / (name.substr(0, dash + 1) + std::to_string(number + 1))) << "left";
  const TemporaryFile file(folder.path() / "a");
  EXPECT_EQ(names_in(folder.path()).size(), 2U);
}

}  // namespace
}  // namespace biotomy::reconstruct
