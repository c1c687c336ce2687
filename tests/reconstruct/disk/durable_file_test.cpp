#include "reconstruct/disk/durable_file.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include "reconstruct/disk/sha256.hpp"
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

TEST(VerifiedFile, GetsItsNameOnlyWhenItIsPublished) {
  const TemporaryFolder folder;
  write_durably(folder.path() / "a", std::string("old"));
  const std::string text = "abc";
  VerifiedFile file(folder.path() / "a", std::as_bytes(std::span(text)));
  EXPECT_EQ(sha256_of_file(folder.path() / "a"), sha256(std::as_bytes(std::span("old", 3))));
  file.publish();
  EXPECT_EQ(file.bytes(), 3U);
  // FIPS 180-2, appendix B.1.
  EXPECT_EQ(file.sha256(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_file(folder.path() / "a"), file.sha256());
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a"));
}

TEST(VerifiedFile, LeavesNothingWhenItIsGivenUp) {
  const TemporaryFolder folder;
  write_durably(folder.path() / "a", std::string("old"));
  { const VerifiedFile file(folder.path() / "a", std::as_bytes(std::span("new", 3))); }
  EXPECT_EQ(read_file(folder.path() / "a").size(), 3U);
  EXPECT_THAT(names_in(folder.path()), ElementsAre("a"));
}

TEST(DurableFile, RemovesWhatAKilledProcessLeftUnfinishedAndNothingElse) {
  const TemporaryFolder folder;
  const auto deep = folder.path() / "c" / "0";
  std::filesystem::create_directories(deep);
  const std::string nobody = "999999999";  // no process has such a number
  const std::string parent = std::to_string(::getppid());
  write_text(folder.path() / (".zarr.json." + nobody + "-17"), "half");
  write_text(deep / (".3." + nobody + "-0"), "half");
  write_text(deep / (".3." + std::to_string(::getpid()) + "-1"), "of a process of our number");
  const std::vector<std::string> others{"3",
                                        ".3." + parent + "-0",
                                        ".hidden",
                                        "3." + nobody + "-0",
                                        ".3." + nobody,
                                        ".3." + nobody + "-",
                                        ".3." + nobody + "-0.json",
                                        "." + nobody + "-0"};
  for (const std::string& name : others) write_text(deep / name, "precious");
  std::filesystem::create_directory(deep / (".folder." + nobody + "-0"));

  remove_unfinished_writes(folder.path());
  EXPECT_THAT(names_in(folder.path()), ElementsAre("c"));
  std::vector<std::string> kept = others;
  kept.push_back(".folder." + nobody + "-0");
  EXPECT_THAT(names_in(deep), testing::UnorderedElementsAreArray(kept));
}

TEST(DurableFile, HashOfAMissingFileIsAnError) {
  EXPECT_THAT(message_of<SampleError>([] { sha256_of_file("/nowhere/a"); }),
              StartsWith("/nowhere/a: cannot open it"));
}

}  // namespace
}  // namespace biotomy::reconstruct
