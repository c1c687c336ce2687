#include "acquisition/records/sample_lock.hpp"

#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using acquisition::SampleLock;
using acquisition::SampleLockError;
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

}  // namespace
}  // namespace biotomy::tests
