#include "acquisition/service/secret_file.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct SecretFile : testing::Test {
  TemporaryFolder folder;
  std::filesystem::path file = folder / "token";

  auto refuses(const std::string& part) { return ThrowsMessage<SecretFileError>(HasSubstr(part)); }
  auto reading(const std::filesystem::path& path) {
    return [path] { read_secret_file(path, "the token file"); };
  }
};

TEST_F(SecretFile, IsMadeForItsOwnerAloneAndReadAgain) {
  EXPECT_TRUE(make_secret_file(file, "the token file", "a secret\n"));
  struct stat information {};
  ASSERT_EQ(::stat(file.c_str(), &information), 0);
  EXPECT_EQ(information.st_mode & 0777U, 0600U);
  EXPECT_EQ(read_secret_file(file, "the token file"), "a secret\n");
}

TEST_F(SecretFile, LeavesNothingElseBehind) {
  make_secret_file(file, "the token file", "first");
  make_secret_file(file, "the token file", "second");
  const auto entries = std::filesystem::directory_iterator(file.parent_path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST_F(SecretFile, IsNeverMadeOverOneThatIsThere) {
  make_secret_file(file, "the token file", "first");
  EXPECT_FALSE(make_secret_file(file, "the token file", "second"));
  EXPECT_EQ(read_secret_file(file, "the token file"), "first");
}

TEST_F(SecretFile, IsRefusedWithAnyRightForGroupOrOthers) {
  make_secret_file(file, "the token file", "a secret");
  for (const mode_t mode : {0640, 0620, 0610, 0604, 0602, 0601}) {
    ::chmod(file.c_str(), mode);
    EXPECT_THAT(reading(file), refuses("chmod 600")) << std::oct << mode;
  }
  ::chmod(file.c_str(), 0400);
  EXPECT_EQ(read_secret_file(file, "the token file"), "a secret");
}

TEST_F(SecretFile, IsNotReachedThroughALink) {
  make_secret_file(file, "the token file", "a secret");
  std::filesystem::create_symlink(file, folder / "link");
  EXPECT_THAT(reading(folder / "link"), refuses("is a symbolic link"));
}

TEST_F(SecretFile, IsNoFolderAndNoPipe) {
  std::filesystem::create_directory(folder / "folder");
  EXPECT_THAT(reading(folder / "folder"), refuses("not a regular file"));
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(reading(folder / "pipe"), refuses("not a regular file"));
}

TEST_F(SecretFile, IsRefusedWhenItBelongsToAnotherUser) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give a file to another user";
  make_secret_file(file, "the token file", "a secret");
  ASSERT_EQ(::chown(file.c_str(), 12345, 12345), 0);
  EXPECT_THAT(reading(file), refuses("belongs to the user 12345"));
}

TEST_F(SecretFile, IsNamedWhenItCannotBeReadOrIsTooLarge) {
  EXPECT_THAT(reading(folder / "missing"),
              refuses("the token file " + (folder / "missing").string()));
  make_secret_file(file, "the token file", std::string(70000, 'x'));
  EXPECT_THAT(reading(file), refuses("larger than 64 KiB"));
}

}  // namespace
}  // namespace biotomy::tests
