#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/integration/child_process.hpp"

namespace biotomy::tests {

constexpr int kLayers = 5;

/// Numbered images of 40 × 30 pixels in a new folder, no two rows or layers alike.
inline void write_small_images(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (int layer = 1; layer <= kLayers; ++layer) {
    cv::Mat image(30, 40, CV_8UC3);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        image.at<cv::Vec3b>(y, x) = {cv::saturate_cast<uchar>(40 * layer),
                                     cv::saturate_cast<uchar>(8 * y),
                                     cv::saturate_cast<uchar>(6 * x)};
      }
    }
    cv::imwrite(folder / ("face" + std::to_string(layer) + ".png"), image);
  }
}

/// The command that makes a sample of them: three bands, the last of one layer, of two shards each.
inline std::vector<std::string> import_command(const std::filesystem::path& images,
                                               const std::filesystem::path& sample) {
  return {BIOTOMY_TOOL, "import",  images,    "--spacing", "10,10,20", "--chunk",
          "16,16,2",    "--shard", "32,32,2", "-o",        sample};
}

/// The picture of a plane through all layers, of pixels that are as large as a voxel of the level
/// (0 or 1), which is read for it.
inline std::vector<std::string> section_command(const std::filesystem::path& sample,
                                                const std::filesystem::path& picture,
                                                int level = 0) {
  return {BIOTOMY_TOOL,
          "section",
          sample,
          "--points",
          "0,0,0 390,0,0 0,290,80",
          "--pixel",
          level == 0 ? "10" : "20",
          "-o",
          picture};
}

}  // namespace biotomy::tests
