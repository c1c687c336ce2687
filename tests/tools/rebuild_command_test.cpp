#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "acquisition/records/sample_lock.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/store/volume.hpp"
#include "tests/another_user.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"
#include "tools/command.hpp"

namespace biotomy::tools {
namespace {

class RebuildCommand : public testing::Test {
 protected:
  void run(const std::string& folder) const {
    CLI::App app;
    add_rebuild_command(app);
    std::vector<std::string> arguments{folder, "rebuild"};  // the last first, as CLI11 wants them
    app.parse(arguments);
  }

  tests::TemporaryFolder folder_;
  reconstruct::SampleFolder sample_ =
      reconstruct::sample_with_layers(folder_ / "s", {20, 10, 3}, 8, 3);
};

TEST_F(RebuildCommand, MakesTheVolumeAnew) {
  run(sample_.path().string());
  EXPECT_EQ(reconstruct::Volume::open(sample_.volume_path()).layers_present(), 3);
}

TEST_F(RebuildCommand, KeepsAwayFromASampleThatADaemonWorksOn) {
  const acquisition::SampleLock daemon(sample_.path());
  EXPECT_THROW(run(sample_.path().string()), acquisition::SampleLockError);
  EXPECT_THROW(run(sample_.path().string() + "/"), acquisition::SampleLockError);
  EXPECT_FALSE(std::filesystem::exists(sample_.volume_path()));
}

TEST_F(RebuildCommand, IsForTheOwnerOfTheSampleToRun) {
  if (!tests::AnotherUser::can_be()) GTEST_SKIP() << "only root can be another user";
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0777), 0);
  const tests::AnotherUser stranger;
  EXPECT_THAT(
      reconstruct::message_of<reconstruct::SampleError>([&] { run(sample_.path().string()); }),
      testing::HasSubstr("belongs to root"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / ".s.lock"));
}

TEST_F(RebuildCommand, OfWhatIsNoSampleFails) {
  EXPECT_THROW(run(folder_.path().string()), reconstruct::SampleError);
}

}  // namespace
}  // namespace biotomy::tools
