#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/integration/child_process.hpp"

namespace biotomy::tests {

/// Makes folder/images, `layers` pictures of 400 × 300 pixels of noise, and imports them to
/// folder/sample with voxels of 10 × 10 × 20 µm.
inline void import_noise(const std::filesystem::path& folder, int layers) {
  const std::filesystem::path images = folder / "images";
  std::filesystem::create_directory(images);
  cv::RNG random(1);
  for (int i = 0; i < layers; ++i) {
    cv::Mat image(300, 400, CV_8UC3);
    random.fill(image, cv::RNG::UNIFORM, 0, 256);
    cv::imwrite(images / (std::to_string(i) + ".png"), image);
  }
  const Outcome outcome = run(
      {BIOTOMY_TOOL, "import", images, "--spacing", "10,10,20", "-o", folder / "sample"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
}

}  // namespace biotomy::tests
