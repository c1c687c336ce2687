#include "reconstruct/disk/folder_swap.hpp"

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::ElementsAre;

class AFolderSwap : public testing::Test {
 protected:
  AFolderSwap() {
    std::filesystem::create_directory(fresh_);
    write_text(fresh_ / "new", "x");
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path fresh_ = folder_ / ".fresh";
  std::filesystem::path place_ = folder_ / "place";
};

TEST_F(AFolderSwap, PutsTheNewContentInThePlaceOfTheOld) {
  std::filesystem::create_directory(place_);
  write_text(place_ / "old", "x");
  replace_folder(fresh_, place_);
  EXPECT_THAT(names_in(place_), ElementsAre("new"));
  EXPECT_THAT(names_in(folder_.path()), ElementsAre("place"));
}

TEST_F(AFolderSwap, TakesAPlaceWhereNothingIs) {
  replace_folder(fresh_, place_);
  EXPECT_THAT(names_in(place_), ElementsAre("new"));
  EXPECT_THAT(names_in(folder_.path()), ElementsAre("place"));
}

TEST_F(AFolderSwap, LeavesTheOldContentWhenThereIsNoNewOne) {
  std::filesystem::create_directory(place_);
  write_text(place_ / "old", "x");
  EXPECT_THAT(message_of<SampleError>([&] { replace_folder(folder_ / "nowhere", place_); }),
              testing::HasSubstr(place_.string()));
  EXPECT_THAT(names_in(place_), ElementsAre("old"));
}

TEST_F(AFolderSwap, ThatWasKilledBetweenItsRenamesIsTakenBack) {
  std::filesystem::create_directory(name_aside(fresh_));
  write_text(name_aside(fresh_) / "old", "x");
  settle_replaced_folder(fresh_, place_);
  EXPECT_THAT(names_in(place_), ElementsAre("old"));
  EXPECT_THAT(names_in(folder_.path()), testing::UnorderedElementsAre("place", ".fresh"));
}

TEST_F(AFolderSwap, ThatWasKilledAfterItsRenamesIsBroughtToItsEnd) {
  std::filesystem::rename(fresh_, place_);
  std::filesystem::create_directory(name_aside(fresh_));
  settle_replaced_folder(fresh_, place_);
  settle_replaced_folder(fresh_, place_);
  EXPECT_THAT(names_in(place_), ElementsAre("new"));
  EXPECT_THAT(names_in(folder_.path()), ElementsAre("place"));
}

TEST_F(AFolderSwap, RemovesAFolderThatIsThereOrNot) {
  remove_folder(fresh_);
  remove_folder(fresh_);
  EXPECT_TRUE(names_in(folder_.path()).empty());
}

}  // namespace
}  // namespace biotomy::reconstruct
