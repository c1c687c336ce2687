#include "tests/bench/named_planes.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::bench {
namespace {

using reconstruct::InvalidRequest;
using reconstruct::SampleError;
using testing::HasSubstr;

class PlanesInAFile : public testing::Test {
 protected:
  std::vector<NamedPlane> read(const std::string& text, const std::string& only = {}) const {
    std::ofstream(file_) << text;
    return read_planes(file_, only);
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "planes.txt";
};

TEST_F(PlanesInAFile, HaveANameAndThreePoints) {
  const auto planes = read("# comment\n\nsteep 0 1 2 3.5 4 5 6 7 -8e1\nmild 1 1 1 2 2 2 3 3 3\n");
  ASSERT_EQ(planes.size(), 2U);
  EXPECT_EQ(planes[0].name, "steep");
  EXPECT_EQ(planes[0].points[0], (reconstruct::Vector3{0, 1, 2}));
  EXPECT_EQ(planes[0].points[1], (reconstruct::Vector3{3.5, 4, 5}));
  EXPECT_EQ(planes[0].points[2], (reconstruct::Vector3{6, 7, -80}));
}

TEST_F(PlanesInAFile, CanBeAskedForByName) {
  const std::string text = "a 0 1 2 3 4 5 6 7 8\nb 9 1 2 3 4 5 6 7 8\n";
  const auto planes = read(text, "b");
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_EQ(planes[0].points[0].x, 9.0);
  EXPECT_THROW(read(text, "c"), InvalidRequest);
}

TEST_F(PlanesInAFile, WithTooFewOrTooManyNumbersAreRefusedByLine) {
  for (const char* line : {"a 0 1 2 3 4 5 6 7", "a 0 1 2 3 4 5 6 7 8 9", "a 0 1 2 3 4 x 6 7 8"}) {
    try {
      read(std::string("# first\n") + line + "\n");
      FAIL() << line;
    } catch (const SampleError& error) {
      EXPECT_THAT(error.what(), HasSubstr("line 2"));
    }
  }
}

TEST_F(PlanesInAFile, ThatIsMissingOrEmptyAreAnError) {
  EXPECT_THROW(read_planes(folder_ / "none.txt"), SampleError);
  EXPECT_THROW(read("# nothing\n"), InvalidRequest);
}

}  // namespace
}  // namespace biotomy::bench
