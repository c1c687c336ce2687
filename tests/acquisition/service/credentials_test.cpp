#include "acquisition/service/credentials.hpp"

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

constexpr const char* kAnna = "0123456789abcdef";
constexpr const char* kBert = "fedcba9876543210";

auto parsing(const std::string& text) {
  return [text] { Credentials::parse(text, "token"); };
}

auto refuses(const std::string& part) {
  return ThrowsMessage<SecretFileError>(HasSubstr(part));
}

TEST(Credentials, AreMadeOnceAndReadAgain) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "token";
  Credentials::read_or_make(file);
  std::ifstream stream(file);
  std::string token;
  stream >> token;
  EXPECT_EQ(token.size(), 64U);
  EXPECT_EQ(Credentials::read_or_make(file).owner_of(token), "operator");
  Credentials::read_or_make(folder / "other");
  EXPECT_EQ(Credentials::read_or_make(folder / "other").owner_of(token), std::nullopt);
}

TEST(Credentials, KnowTheOwnerOfEachToken) {
  const Credentials read = Credentials::parse(
      std::string("# who may\n\nanna ") + kAnna + "\n  bert\t" + kBert + "  \r\n", "token");
  EXPECT_EQ(read.owner_of(kAnna), "anna");
  EXPECT_EQ(read.owner_of(kBert), "bert");
  EXPECT_EQ(read.owner_of("0123456789abcdeF"), std::nullopt);
  EXPECT_EQ(read.owner_of("0123456789abcdef0"), std::nullopt);
  EXPECT_EQ(read.owner_of("anna"), std::nullopt);
  EXPECT_EQ(read.owner_of(""), std::nullopt);
}

TEST(Credentials, RefuseWhatIsNoTokenFile) {
  EXPECT_THAT(parsing("\n"), refuses("holds no token"));
  EXPECT_THAT(parsing("short\n"), refuses("less than 16 characters"));
  EXPECT_THAT(parsing(std::string("anna ") + kAnna + "\nanna " + kBert), refuses("anna again"));
  EXPECT_THAT(parsing(std::string("anna ") + kAnna + "\n" + kBert), refuses("without a name"));
  EXPECT_THAT(parsing(std::string("an/na ") + kAnna), refuses("in line 1"));
}

TEST(Credentials, NeverShowATokenInAComplaint) {
  EXPECT_THAT(parsing(std::string("anna the ") + kAnna),
              ThrowsMessage<SecretFileError>(AllOf(HasSubstr("line 1"), Not(HasSubstr(kAnna)))));
}

}  // namespace
}  // namespace biotomy::tests
