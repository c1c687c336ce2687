#include "reconstruct/export/unfinished_export.hpp"

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class AnUnfinishedExport : public testing::Test {
 protected:
  auto names() const { return names_in(folder_.path()); }

  tests::TemporaryFolder folder_;
  std::filesystem::path output_ = folder_ / "out";
};

TEST_F(AnUnfinishedExport, HasItsNameOnlyWhenItIsFinished) {
  UnfinishedExport unfinished(output_);
  write_plainly(unfinished.folder() / "a", "x", 1);
  EXPECT_THAT(names(), ElementsAre(".out.partial"));
  unfinished.finish();
  EXPECT_THAT(names(), ElementsAre("out"));
  EXPECT_THAT(names_in(output_), ElementsAre("a"));
}

TEST_F(AnUnfinishedExport, LeavesNothingWhenItIsNot) {
  {
    const UnfinishedExport unfinished(output_);
    write_plainly(unfinished.folder() / "a", "x", 1);
  }
  EXPECT_THAT(names(), IsEmpty());
}

TEST_F(AnUnfinishedExport, BeginsAnewAfterOneThatWasKilled) {
  std::filesystem::create_directory(folder_ / ".out.partial");
  write_text(folder_ / ".out.partial" / "old", "x");
  UnfinishedExport(output_ / "").finish();
  EXPECT_THAT(names_in(output_), IsEmpty());
}

TEST_F(AnUnfinishedExport, IsNotTakenFromWhoIsAtWorkOnIt) {
  const UnfinishedExport unfinished(output_);
  write_plainly(unfinished.folder() / "a", "x", 1);
  EXPECT_THAT(message_of<SampleError>([&] { UnfinishedExport second(output_); }),
              testing::HasSubstr("another export of it is at work"));
  EXPECT_THAT(names_in(unfinished.folder()), ElementsAre("a"));
}

TEST_F(AnUnfinishedExport, TouchesNothingThatIsThere) {
  std::filesystem::create_directory(output_);
  write_text(output_ / "precious", "x");
  EXPECT_THROW(UnfinishedExport{output_}, SampleError);
  EXPECT_THAT(names_in(output_), ElementsAre("precious"));
}

TEST_F(AnUnfinishedExport, RefusesALinkBeforeAnythingIsWritten) {
  std::filesystem::create_directory(folder_ / "empty");
  std::filesystem::create_directory_symlink(folder_ / "empty", output_);
  EXPECT_THAT(message_of<SampleError>([&] { UnfinishedExport refused(output_); }),
              testing::HasSubstr("is a symbolic link"));
  EXPECT_THAT(names(), testing::UnorderedElementsAre("empty", "out"));
}

TEST_F(AnUnfinishedExport, LeavesAnInterruptedImportAlone) {
  const auto kept = folder_ / ".out.partial";
  std::filesystem::create_directories(kept / "sample");
  write_text(kept / "request.json", "{}");
  EXPECT_THAT(
      message_of<SampleError>([&] { UnfinishedExport refused(output_); }),
      testing::AllOf(testing::HasSubstr("interrupted import"), testing::HasSubstr(kept.string())));
  EXPECT_THAT(names_in(kept), testing::UnorderedElementsAre("request.json", "sample"));
}

TEST_F(AnUnfinishedExport, NamesAFileThatCannotBeWritten) {
  const auto path = folder_ / "nowhere" / "a";
  EXPECT_THAT(message_of<SampleError>([&] { write_plainly(path, "x", 1); }),
              testing::HasSubstr(path.string()));
  EXPECT_THROW(write_plainly("/dev/full", "x", 1), SampleError);
}

}  // namespace
}  // namespace biotomy::reconstruct
