#include "reconstruct/disk/folder_owner.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "reconstruct/errors.hpp"
#include "tests/another_user.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using tests::AnotherUser;

class AFolderOfAnotherUser : public testing::Test {
 protected:
  void SetUp() override {
    if (!AnotherUser::can_be()) GTEST_SKIP() << "only root can be another user";
    ASSERT_EQ(::chmod(folder_.path().c_str(), 0755), 0);
    std::filesystem::create_directories(tree_ / "c");
    write_text(tree_ / "c" / "0", "x");
    write_text(outside_, "x");
    std::filesystem::create_symlink(outside_, tree_ / "link");
  }
  void give_folder_to(uid_t user, gid_t group) const {
    ASSERT_EQ(::chown(folder_.path().c_str(), user, group), 0);
  }
  /// User and group.
  static std::pair<uid_t, gid_t> owner_of(const std::filesystem::path& file) {
    struct stat found {};
    EXPECT_EQ(::lstat(file.c_str(), &found), 0);
    return {found.st_uid, found.st_gid};
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path tree_ = folder_ / "tree";
  std::filesystem::path outside_ = folder_ / "outside";
};

TEST_F(AFolderOfAnotherUser, GetsAllThatRootMakesInIt) {
  give_folder_to(AnotherUser::kNumber, 54321);
  give_to_owner_of(folder_.path(), tree_);
  for (const char* name : {"", "c", "c/0", "link"}) {
    EXPECT_EQ(owner_of(tree_ / name), std::pair(AnotherUser::kNumber, gid_t{54321})) << name;
  }
  EXPECT_EQ(owner_of(outside_).first, 0U);
}

TEST_F(AFolderOfAnotherUser, LeavesToRootWhatIsInAFolderOfRoot) {
  give_folder_to(0, 54321);
  give_to_owner_of(folder_.path(), tree_);
  EXPECT_EQ(owner_of(tree_ / "c"), std::pair(uid_t{0}, gid_t{0}));
}

TEST_F(AFolderOfAnotherUser, IsForItsOwnerAndRootToChange) {
  EXPECT_NO_THROW(check_acts_for_owner(folder_.path()));
  {
    const AnotherUser stranger;
    EXPECT_THAT(message_of<SampleError>([&] { check_acts_for_owner(folder_.path()); }),
                AllOf(HasSubstr(folder_.path().string()), HasSubstr("belongs to root")));
  }
  give_folder_to(AnotherUser::kNumber, 54321);
  EXPECT_NO_THROW(check_acts_for_owner(folder_.path()));
  const AnotherUser owner;
  EXPECT_NO_THROW(check_acts_for_owner(folder_.path()));
}

}  // namespace
}  // namespace biotomy::reconstruct
