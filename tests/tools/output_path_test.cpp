#include "tools/output_path.hpp"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tools {
namespace {

namespace fs = std::filesystem;
using reconstruct::InvalidRequest;
using testing::HasSubstr;

class OutputPath : public testing::Test {
 protected:
  OutputPath() {
    fs::create_directories(sample_ / "layers");
    reconstruct::write_text(sample_ / "sample.toml", "");
    fs::create_directory(folder_ / "elsewhere");
  }

  static bool is_refused(const fs::path& output) {
    try {
      refuse_output_in_sample("--output", output);
      return false;
    } catch (const InvalidRequest&) {
      return true;
    }
  }

  tests::TemporaryFolder folder_;
  fs::path sample_ = folder_ / "knee";
};

TEST_F(OutputPath, IsRefusedInASampleAndTakenBesideIt) {
  EXPECT_TRUE(is_refused(sample_));
  EXPECT_TRUE(is_refused(sample_ / "a.png"));
  EXPECT_TRUE(is_refused(sample_ / "layers/000001.tif"));
  EXPECT_TRUE(is_refused(sample_ / "not/there/yet/"));
  EXPECT_FALSE(is_refused(folder_ / "knee.png"));
  EXPECT_FALSE(is_refused(folder_ / "knee-exports/a.png"));
  EXPECT_FALSE(is_refused(folder_ / "not/there/yet/"));
}

TEST_F(OutputPath, IsLookedForWhereItReallyLies) {
  EXPECT_TRUE(is_refused(folder_ / "elsewhere/../knee/a.png"));
  EXPECT_FALSE(is_refused(sample_ / "../elsewhere/a.png"));
  const fs::path relative = fs::relative(sample_);
  EXPECT_TRUE(is_refused(relative / "a.png"));
  EXPECT_FALSE(is_refused("a.png"));
}

TEST_F(OutputPath, IsRefusedThroughLinksAndInPlaceOfOne) {
  fs::create_directory_symlink(sample_ / "layers", folder_ / "linked");
  EXPECT_TRUE(is_refused(folder_ / "linked/000001.tif"));
  reconstruct::write_text(sample_ / "layers/000001.tif", "");
  fs::create_symlink(sample_ / "layers/000001.tif", folder_ / "a.tif");
  EXPECT_TRUE(is_refused(folder_ / "a.tif"));
  fs::create_directory_symlink(folder_ / "elsewhere", sample_ / "out");
  EXPECT_TRUE(is_refused(sample_ / "out"));
  EXPECT_FALSE(is_refused(sample_ / "out/a.png"));
}

TEST_F(OutputPath, SaysWhatIsWrongAndWhatToDo) {
  const std::string message = reconstruct::message_of<InvalidRequest>(
      [&] { refuse_output_in_sample("--movie", sample_ / "a.mp4"); });
  EXPECT_EQ(message, "--movie " + (sample_ / "a.mp4").string() + ": lies in the sample " +
                         fs::canonical(sample_).string() +
                         ", whose files are not for results: name a place outside it");
}

}  // namespace
}  // namespace biotomy::tools
