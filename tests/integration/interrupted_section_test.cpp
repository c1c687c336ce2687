#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "reconstruct/picture/image_file.hpp"
#include "tests/integration/child_process.hpp"
#include "tests/integration/noisy_sample.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

/// Whenever the signal comes, the picture is whole or not there, and so says the exit code.
TEST(AnInterruptedSection, LeavesAWholePictureOrNone) {
  const TemporaryFolder folder;
  ASSERT_NO_FATAL_FAILURE(import_noise(folder.path(), 4));

  const fs::path pictures = folder / "pictures";
  fs::create_directory(pictures);
  const fs::path picture = pictures / "a.png";
  int interrupted = 0;
  for (int delay_ms = 0; delay_ms < 400; delay_ms += 40) {
    ChildProcess cutting({BIOTOMY_TOOL, "section", folder / "sample", "--normal", "0,0,1",
                          "--through", "0,0,30", "--pixel", "0.8", "-o", picture},
                         folder.path());
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
    cutting.send(SIGINT);
    const Outcome outcome = cutting.wait(std::chrono::seconds(60));
    if (outcome.exit_code == 0) {
      EXPECT_EQ(reconstruct::read_image_file(picture).size(), cv::Size(4988, 3738));
      fs::remove(picture);
    } else {
      ++interrupted;
      // The signal's own code when it came before the work began.
      EXPECT_TRUE(outcome.exit_code == 1 || outcome.exit_code == 128 + SIGINT) << outcome.exit_code;
    }
    EXPECT_TRUE(fs::is_empty(pictures)) << delay_ms;
  }
  EXPECT_GT(interrupted, 0);
}

}  // namespace
}  // namespace biotomy::tests
