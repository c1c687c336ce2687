#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "reconstruct/picture/image_file.hpp"
#include "tests/integration/child_process.hpp"
#include "tests/integration/noisy_sample.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

/// A series that is ended by a signal while it is being cut, and taken up by the same command.
class InterruptedSeries : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { import_noise(folder_.path(), 8); }

  std::vector<std::string> command(const std::string& name) const {
    return {BIOTOMY_TOOL,
            "series",
            folder_ / "sample",
            "rotate",
            "--axis",
            "x",
            "--to",
            "30",
            "--step",
            "0.25",
            "-o",
            folder_ / name,
            "--movie",
            folder_ / (name + ".mp4")};
  }

  std::size_t frames_in(const std::string& name) const {
    std::size_t count = 0;
    std::error_code not_yet;
    for (const auto& entry : fs::directory_iterator(folder_ / name, not_yet)) {
      count += entry.path().extension() == ".png" && entry.path().filename().string()[0] != '.';
    }
    return count;
  }

  TemporaryFolder folder_;
};

constexpr std::size_t kFrames = 121;

TEST_P(InterruptedSeries, LeavesWholeFramesAndIsTakenUp) {
  {
    ChildProcess cutting(command("a"), folder_.path());
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (frames_in("a") < 10) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "no frame was made";
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    cutting.send(GetParam());
    const Outcome outcome = cutting.wait(std::chrono::seconds(30));
    if (GetParam() == SIGKILL) {
      EXPECT_EQ(outcome.exit_code, 128 + SIGKILL);
    } else {
      EXPECT_EQ(outcome.exit_code, 1);
      EXPECT_NE(outcome.errors.find("takes the series up"), std::string::npos) << outcome.errors;
      EXPECT_FALSE(fs::exists(folder_ / ".a.mp4.partial"));
    }
  }
  const std::size_t left = frames_in("a");
  ASSERT_LT(left, kFrames) << "the series was finished before it could be interrupted";
  EXPECT_FALSE(fs::exists(folder_ / "a.mp4"));
  const auto kept_since = fs::last_write_time(folder_ / "a/000_+000.00deg.png");
  for (const auto& entry : fs::directory_iterator(folder_ / "a")) {
    if (entry.path().extension() == ".png" && entry.path().filename().string()[0] != '.') {
      EXPECT_NO_THROW(reconstruct::read_image_file(entry.path()));
    }
  }

  const Outcome again = run(command("a"), folder_.path());
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(again.errors, "");
  EXPECT_EQ(fs::last_write_time(folder_ / "a/000_+000.00deg.png"), kept_since);
  EXPECT_EQ(frames_in("a"), kFrames);
  const std::string folder = folder_.path();
  const Outcome film = run({"/bin/sh", "-c",
                            "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
                            "stream=nb_read_frames -of csv=p=0 '" +
                                folder + "/a.mp4'"},
                           folder_.path());
  EXPECT_EQ(film.output, "121\n") << film.errors;

  // As if nothing had happened.
  ASSERT_EQ(run(command("b"), folder_.path()).exit_code, 0);
  const Outcome difference =
      run({"/bin/sh", "-c", "diff -r '" + folder + "/a' '" + folder + "/b'"}, folder_.path());
  EXPECT_EQ(difference.exit_code, 0) << difference.output;
}

INSTANTIATE_TEST_SUITE_P(, InterruptedSeries, testing::Values(SIGINT, SIGTERM, SIGKILL),
                         [](const auto& signal) {
                           return signal.param == SIGINT    ? "ByInt"
                                  : signal.param == SIGTERM ? "ByTerm"
                                                            : "ByKill";
                         });

}  // namespace
}  // namespace biotomy::tests
