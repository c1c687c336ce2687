#include "reconstruct/store/durable_file.hpp"

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using tests::TemporaryFolder;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(DurableFile, HoldsWhatWasWrittenAndLeavesNothingBeside) {
  const TemporaryFolder folder;
  write_durably(folder.path() / "a.txt", std::string("first"));
  write_durably(folder.path() / "a.txt", std::string("second"));
  EXPECT_EQ(read_file(folder.path() / "a.txt").size(), 6U);
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a.txt"));
}

TEST(DurableFile, HoldsItsPartsOneAfterTheOther) {
  const TemporaryFolder folder;
  const FileParts parts{{std::byte{1}, std::byte{2}}, {}, {std::byte{3}}};
  write_durably(folder.path() / "a", parts);
  EXPECT_THAT(read_file(folder.path() / "a"),
              ElementsAre(std::byte{1}, std::byte{2}, std::byte{3}));
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a"));
}

TEST(DurableFile, NamesTheFileAndTheReasonWhenTheFolderIsMissing) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "missing" / "a.txt";
  EXPECT_THAT(message_of<SampleError>([&] { write_durably(path, std::string("x")); }),
              testing::AllOf(StartsWith(path.string()), HasSubstr("No such file")));
}

TEST(DurableFile, RemovesTheTemporaryFileWhenTheNameIsTakenByAFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "taken");
  EXPECT_THROW(write_durably(folder.path() / "taken", std::string("x")), SampleError);
  EXPECT_THAT(names_in(folder.path()), ElementsAre("taken"));
}

TEST(DurableFile, VerifiedWritingReturnsTheHashOfTheFile) {
  const TemporaryFolder folder;
  const std::string text = "abc";
  const std::string hash =
      write_durably_verified(folder.path() / "a", std::as_bytes(std::span(text)));
  // FIPS 180-2, appendix B.1.
  EXPECT_EQ(hash, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_file(folder.path() / "a"), hash);
}

TEST(DurableFile, HashOfAMissingFileIsAnError) {
  EXPECT_THAT(message_of<SampleError>([] { sha256_of_file("/nowhere/a"); }),
              StartsWith("/nowhere/a: cannot open it"));
}

}  // namespace
}  // namespace biotomy::reconstruct
