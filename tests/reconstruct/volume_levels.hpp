#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "reconstruct/store/volume.hpp"

namespace biotomy::reconstruct {

/// All layers of a level, put together from its chunks; black where there is none.
inline std::vector<cv::Mat> stored_level(const Volume& volume, int level) {
  const auto& chunk = volume.layout().chunk;
  const GridSize size = volume.level(level).size;
  const int type = volume.bits() == 8 ? CV_8UC3 : CV_16UC3;
  const cv::Rect face(0, 0, static_cast<int>(size.x), static_cast<int>(size.y));
  std::vector<cv::Mat> layers(static_cast<std::size_t>(size.z));
  for (cv::Mat& layer : layers) {
    layer = cv::Mat(face.size(), type, cv::Scalar::all(0));
  }
  for (int z = 0; z < size.z; z += chunk[0]) {
    for (int y = 0; y < size.y; y += chunk[1]) {
      for (int x = 0; x < size.x; x += chunk[2]) {
        const auto voxels = volume.read_chunk(level, {z / chunk[0], y / chunk[1], x / chunk[2]});
        for (int k = 0; voxels && k < chunk[0] && z + k < size.z; ++k) {
          const std::size_t plane = voxels->size() / static_cast<std::size_t>(chunk[0]);
          auto* data = const_cast<std::byte*>(voxels->data()) + plane * static_cast<std::size_t>(k);
          const cv::Rect part = cv::Rect(x, y, chunk[2], chunk[1]) & face;
          cv::Mat(chunk[1], chunk[2], type, data)(cv::Rect(cv::Point(0, 0), part.size()))
              .copyTo(layers[static_cast<std::size_t>(z + k)](part));
        }
      }
    }
  }
  return layers;
}

/// The mean of the voxels of `finer` that a voxel of the next level stands for, by its definition,
/// one voxel at a time. `finer` holds only the layers that there are.
template <typename Value>
cv::Mat slow_mean_layer(const std::vector<cv::Mat>& finer, const GridSize& size, std::int64_t k,
                        const LevelFactor& step) {
  using Pixel = cv::Vec<Value, 3>;
  cv::Mat mean(static_cast<int>(size.y), static_cast<int>(size.x), finer.front().type());
  for (int j = 0; j < mean.rows; ++j) {
    for (int i = 0; i < mean.cols; ++i) {
      for (int c = 0; c < 3; ++c) {
        double sum = 0.0;
        int count = 0;
        for (std::int64_t z = k * step.z; z < (k + 1) * step.z; ++z) {
          for (std::int64_t y = j * step.y; y < (j + 1) * step.y; ++y) {
            for (std::int64_t x = i * step.x; x < (i + 1) * step.x; ++x) {
              if (z < static_cast<std::int64_t>(finer.size()) && y < finer.front().rows &&
                  x < finer.front().cols) {
                sum += finer[static_cast<std::size_t>(z)].template at<Pixel>(
                    static_cast<int>(y), static_cast<int>(x))[c];
                ++count;
              }
            }
          }
        }
        mean.template at<Pixel>(j, i)[c] = static_cast<Value>(std::floor(sum / count + 0.5));
      }
    }
  }
  return mean;
}

/// The layers of the next level that `finer`, the layers that there are, makes.
inline std::vector<cv::Mat> slow_next_level(const std::vector<cv::Mat>& finer,
                                            const PyramidLevel& before, const PyramidLevel& level) {
  const LevelFactor step{level.factor.x / before.factor.x, level.factor.y / before.factor.y,
                         level.factor.z / before.factor.z};
  std::vector<cv::Mat> layers;
  for (std::int64_t k = 0; k * step.z < static_cast<std::int64_t>(finer.size()); ++k) {
    layers.push_back(finer.front().depth() == CV_8U
                         ? slow_mean_layer<std::uint8_t>(finer, level.size, k, step)
                         : slow_mean_layer<std::uint16_t>(finer, level.size, k, step));
  }
  return layers;
}

}  // namespace biotomy::reconstruct
