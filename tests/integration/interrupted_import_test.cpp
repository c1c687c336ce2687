#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "tests/integration/child_process.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

using reconstruct::contents_of;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kLayers = 40;

class InterruptedImport : public testing::Test {
 protected:
  InterruptedImport() {
    fs::create_directory(images_);
    for (int i = 1; i <= kLayers; ++i) {
      reconstruct::save_rgb(
          images_ / (std::to_string(i) + ".png"),
          reconstruct::test_image(300, 200, CV_8UC3, static_cast<std::uint64_t>(i)));
    }
  }

  std::vector<std::string> import(const fs::path& output) const {
    return {BIOTOMY_TOOL, "import",  images_, "--spacing", "1,1,1",  "--shard", "128,128,8",
            "--chunk",    "16,16,8", "-o",    output,      "--name", "knee"};
  }
  /// All but the time at which the import was begun.
  static auto sample_contents(const fs::path& sample) {
    auto contents = contents_of(sample);
    contents.erase("sample.toml");
    return contents;
  }
  auto undisturbed() const {
    const Outcome outcome = run(import(folder_ / "undisturbed"), folder_.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    return sample_contents(folder_ / "undisturbed");
  }
  /// Waits until some layers are stored.
  void wait_for_layers(std::uintmax_t hashes) const {
    const fs::path file = folder_ / ".sample.partial" / "layers.sha256";
    std::error_code error;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!fs::exists(folder_ / "sample") &&
           (!fs::exists(file) || fs::file_size(file, error) < hashes * 82)) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "no layer was stored";
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  TemporaryFolder folder_;
  fs::path images_ = folder_ / "images";
  fs::path sample_ = folder_ / "sample";
};

TEST_F(InterruptedImport, KilledAtAnyMomentBecomesTheSameWhenTakenUpAgain) {
  const auto expected = undisturbed();
  cv::RNG random(3);
  int kills = 0;
  for (bool finished = false; !finished;) {
    ChildProcess child(import(sample_), folder_.path());
    std::this_thread::sleep_for(std::chrono::milliseconds(random.uniform(20, 150 + 30 * kills)));
    child.send(SIGKILL);
    const Outcome outcome = child.wait(std::chrono::seconds(60));
    finished = outcome.exit_code == 0 || fs::exists(sample_);
    kills += finished ? 0 : 1;
    ASSERT_TRUE(finished || outcome.exit_code == 128 + SIGKILL) << outcome.errors;
  }
  EXPECT_GT(kills, 0);
  EXPECT_THAT(reconstruct::differing_files(sample_contents(sample_), expected), testing::IsEmpty());
}

TEST_F(InterruptedImport, EndsSoonAfterASignalAndTellsHowToGoOn) {
  const auto expected = undisturbed();
  {
    ChildProcess child(import(sample_), folder_.path());
    wait_for_layers(3);
    child.send(SIGINT);
    const Outcome outcome = child.wait(std::chrono::seconds(20));
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.errors, AllOf(HasSubstr("interrupted"), HasSubstr("of 40 layers"),
                                      HasSubstr("the same command goes on")));
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1);
    EXPECT_FALSE(fs::exists(sample_));
  }
  const Outcome again = run(import(sample_), folder_.path());
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_THAT(reconstruct::differing_files(sample_contents(sample_), expected), testing::IsEmpty());
  EXPECT_FALSE(fs::exists(folder_ / ".sample.partial"));
}

// A limit to the size of files stands in for a full disk: writing fails in the same way.
TEST_F(InterruptedImport, GoesOnWhenThereIsRoomAgain) {
  const auto expected = undisturbed();
  std::string command = "trap '' XFSZ; ulimit -f 100; exec";
  for (const std::string& word : import(sample_)) command += " '" + word + "'";
  const Outcome full = run({"/bin/bash", "-c", command}, folder_.path());
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_THAT(full.errors, HasSubstr("cannot write it"));
  EXPECT_FALSE(fs::exists(sample_));
  const Outcome again = run(import(sample_), folder_.path());
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_THAT(reconstruct::differing_files(sample_contents(sample_), expected), testing::IsEmpty());
}

TEST_F(InterruptedImport, LeavesHashesThatSha256sumChecks) {
  undisturbed();
  const Outcome checked = run(
      {"/bin/sh", "-c",
       "cd '" + (folder_ / "undisturbed").string() + "' && sha256sum --strict -c layers.sha256"},
      folder_.path());
  EXPECT_EQ(checked.exit_code, 0) << checked.errors;
  EXPECT_EQ(std::count(checked.output.begin(), checked.output.end(), '\n'), kLayers);
  const Outcome verified =
      run({BIOTOMY_TOOL, "verify", folder_ / "undisturbed", "--deep"}, folder_.path());
  EXPECT_EQ(verified.exit_code, 0) << verified.output << verified.errors;
}

}  // namespace
}  // namespace biotomy::tests
