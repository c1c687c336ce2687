#include "acquisition/records/sample_lock.hpp"

#include <fstream>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/another_user.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using acquisition::SampleLock;
using acquisition::SampleLockError;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(SampleLock, KeepsASecondDaemonAwayAsLongAsTheFirstLives) {
  const TemporaryFolder folder;
  const auto sample = folder.path() / "knee";
  std::optional<SampleLock> first(sample);
  EXPECT_THAT([&] { const SampleLock second(sample); },
              ThrowsMessage<SampleLockError>(HasSubstr("another biotomyd works on")));
  const SampleLock other(folder.path() / "elbow");
  first.reset();
  EXPECT_NO_THROW(SampleLock{sample});
}

TEST(SampleLock, IsOneUnderAllNamesOfASample) {
  const TemporaryFolder folder;
  const auto sample = folder.path() / "knee";
  std::filesystem::create_directory(sample);
  std::filesystem::create_directory_symlink(sample, folder.path() / "link");
  const SampleLock lock(sample);
  for (const char* name : {"link", "knee/", "link/"}) {
    EXPECT_THROW(SampleLock{folder.path() / name}, SampleLockError) << name;
    EXPECT_TRUE(SampleLock::is_held(folder.path() / name)) << name;
  }
}

TEST(SampleLock, SaysThatTheFolderAroundTheSampleIsMissing) {
  EXPECT_THAT([] { const SampleLock lock("/nowhere/at/all/knee"); },
              ThrowsMessage<SampleLockError>(HasSubstr("does the folder exist?")));
}

/// A folder of another user, in which there is a sample; the tests act as root and as that user.
class SampleLockOfAnotherUser : public testing::Test {
 protected:
  void SetUp() override {
    if (!AnotherUser::can_be()) GTEST_SKIP() << "only root can be another user";
    std::filesystem::create_directory(sample_);
    for (const auto& folder : {folder_.path(), sample_}) {
      ASSERT_EQ(::chown(folder.c_str(), AnotherUser::kNumber, AnotherUser::kNumber), 0);
    }
  }

  TemporaryFolder folder_;
  std::filesystem::path sample_ = folder_ / "knee";
  std::filesystem::path file_ = folder_ / ".knee.lock";
};

TEST_F(SampleLockOfAnotherUser, IsTheOwnersAlsoWhenRootHasMadeIt) {
  const mode_t mask = ::umask(0077);
  { const SampleLock lock(sample_); }
  ::umask(mask);
  const AnotherUser owner;
  EXPECT_NO_THROW(SampleLock{sample_});
}

TEST_F(SampleLockOfAnotherUser, NeedsOnlyToBeReadable) {
  { const SampleLock lock(sample_); }
  ASSERT_EQ(::chown(file_.c_str(), 0, 0), 0);
  const AnotherUser owner;
  const SampleLock lock(sample_);
  EXPECT_TRUE(SampleLock::is_held(sample_));
}

TEST_F(SampleLockOfAnotherUser, SaysWhatIsToBeDoneWhenItCannotBeOpenedOrMade) {
  { const SampleLock lock(sample_); }
  ASSERT_EQ(::chown(file_.c_str(), 0, 0), 0);
  ASSERT_EQ(::chmod(file_.c_str(), 0600), 0);
  const auto locking = [&] { const SampleLock lock(sample_); };
  {
    const AnotherUser owner;
    EXPECT_THAT(locking, ThrowsMessage<SampleLockError>(
                             AllOf(HasSubstr("cannot be opened"), HasSubstr("remove it when"))));
  }
  std::filesystem::remove(file_);
  ASSERT_EQ(::chown(folder_.path().c_str(), 0, 0), 0);
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0755), 0);
  const AnotherUser stranger;
  EXPECT_THAT(locking, ThrowsMessage<SampleLockError>(
                           AllOf(HasSubstr("cannot be made"), HasSubstr("may write into"))));
}

TEST_F(SampleLockOfAnotherUser, GivesNobodyTheFileThatALinkInItsPlaceNames) {
  std::ofstream(folder_ / "precious") << "root's";
  std::filesystem::create_symlink(folder_ / "precious", file_);
  EXPECT_THROW(SampleLock{sample_}, SampleLockError);
  struct stat found {};
  ASSERT_EQ(::stat((folder_ / "precious").c_str(), &found), 0);
  EXPECT_EQ(found.st_uid, 0U);
}

}  // namespace
}  // namespace biotomy::tests
