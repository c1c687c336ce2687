#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "reconstruct/sample/image_file.hpp"
#include "tests/integration/child_process.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

/// Whenever the signal comes, the picture is whole or not there, and so says the exit code.
TEST(AnInterruptedSection, LeavesAWholePictureOrNone) {
  const TemporaryFolder folder;
  const fs::path images = folder / "images";
  fs::create_directory(images);
  cv::RNG random(1);
  for (int i = 0; i < 4; ++i) {
    cv::Mat image(300, 400, CV_8UC3);
    random.fill(image, cv::RNG::UNIFORM, 0, 256);
    cv::imwrite(images / (std::to_string(i) + ".png"), image);
  }
  const Outcome imported =
      run({BIOTOMY_TOOL, "import", images, "--spacing", "10,10,20", "-o", folder / "sample"},
          folder.path());
  ASSERT_EQ(imported.exit_code, 0) << imported.errors;

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
