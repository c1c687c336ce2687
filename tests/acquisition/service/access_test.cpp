#include "acquisition/service/access.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Access, MakesATokenForItsOwnerAloneAndReadsItAgain) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "token";
  const std::string token = read_or_make_token(file);
  EXPECT_EQ(token.size(), 64U);
  struct stat information {};
  ASSERT_EQ(::stat(file.c_str(), &information), 0);
  EXPECT_EQ(information.st_mode & 0777U, 0600U);
  EXPECT_EQ(read_or_make_token(file), token);
  EXPECT_NE(read_or_make_token(folder.path() / "other"), token);
}

TEST(Access, RefusesATokenThatOthersCanRead) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "token";
  read_or_make_token(file);
  ::chmod(file.c_str(), 0644);
  EXPECT_THAT([&] { read_or_make_token(file); },
              ThrowsMessage<AccessError>(HasSubstr("chmod 600")));
}

TEST(Access, RefusesAnEmptyToken) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "token";
  std::ofstream(file) << "\n";
  ::chmod(file.c_str(), 0600);
  EXPECT_THAT([&] { read_or_make_token(file); },
              ThrowsMessage<AccessError>(HasSubstr("at least 16 characters")));
}

TEST(Access, IsGrantedToTheTokenOnly) {
  const std::string token = "0123456789abcdef";
  EXPECT_EQ(check_access("Bearer 0123456789abcdef", token), Access::granted);
  EXPECT_EQ(check_access("Bearer 0123456789abcdeF", token), Access::wrong_token);
  EXPECT_EQ(check_access("Bearer 0123456789abcdef0", token), Access::wrong_token);
  EXPECT_EQ(check_access("Bearer ", token), Access::wrong_token);
  EXPECT_EQ(check_access("", token), Access::no_token);
  EXPECT_EQ(check_access("Basic 0123456789abcdef", token), Access::no_token);
}

}  // namespace
}  // namespace biotomy::tests
