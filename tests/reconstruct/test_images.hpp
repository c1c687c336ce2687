#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::reconstruct {

/// A picture in which no two layers, rows, columns or colours look alike: gradients with noise.
inline cv::Mat test_image(int width, int height, int type = CV_8UC3, std::uint64_t seed = 1) {
  cv::Mat image(height, width, type);
  cv::RNG random(seed);
  const int scale = CV_MAT_DEPTH(type) == CV_8U ? 1 : 257;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const int value =
            ((x * (c + 1) + 2 * y) / 3 + static_cast<int>(seed) * 7 + random.uniform(0, 6)) % 250 +
            1;
        if (scale == 1) {
          image.at<cv::Vec3b>(y, x)[c] = static_cast<std::uint8_t>(value);
        } else {
          image.at<cv::Vec3w>(y, x)[c] = static_cast<std::uint16_t>(value * scale - 5 * c);
        }
      }
    }
  }
  return image;
}

inline bool same_pixels(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() &&
         cv::norm(a.reshape(1), b.reshape(1), cv::NORM_INF) == 0.0;
}

/// Through OpenCV, whose colours are the other way round.
inline void save_rgb(const std::filesystem::path& path, const cv::Mat& rgb) {
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  cv::imwrite(path.string(), bgr);
}

/// Layer files `first` to `last`, each `test_image` with its number for a seed.
inline void add_layers(const SampleFolder& sample, std::int64_t first, std::int64_t last) {
  const auto& [size, spacing] = sample.description().cuboid;
  const int type = sample.description().bits == 8 ? CV_8UC3 : CV_16UC3;
  for (std::int64_t layer = first; layer <= last; ++layer) {
    write_layer_image(sample.layer_path(layer),
                      test_image(static_cast<int>(size.x), static_cast<int>(size.y), type,
                                 static_cast<std::uint64_t>(layer)),
                      {layer, spacing}, {});
  }
}

/// A sample with the layer files 1 to `layers`, each `test_image` with its number for a seed.
inline SampleFolder sample_with_layers(const std::filesystem::path& path, const GridSize& size,
                                       int bits, std::int64_t layers,
                                       const Vector3& spacing = {10.0, 11.0, 50.0}) {
  SampleDescription description;
  description.name = "test";
  description.created = "2026-01-02T03:04:05Z";
  description.bits = bits;
  description.cuboid = {size, spacing};
  SampleFolder sample = SampleFolder::create(path, description);
  add_layers(sample, 1, layers);
  return sample;
}

}  // namespace biotomy::reconstruct
