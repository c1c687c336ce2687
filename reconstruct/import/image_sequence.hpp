#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/picture/image_file.hpp"

namespace biotomy::reconstruct {

/// Photographs of a stack in the order of the numbers in their names (the last digits in the name:
/// 1, 2, 10, not 1, 10, 2), without a gap. Layer 1 is the lowest number, whatever it is.
class ImageSequence {
 public:
  /// `inputs` is one folder, of which the images with a number in the name are taken and the rest
  /// is not looked at, or any number of image files. Throws SampleError when there is none, when a
  /// number is missing or there twice, or when names differ in more than the number.
  static ImageSequence find(const std::vector<std::filesystem::path>& inputs);

  std::int64_t count() const { return static_cast<std::int64_t>(files_.size()); }
  const std::vector<std::filesystem::path>& files() const { return files_; }

  /// The image of a layer, from 1, CV_8UC3 or CV_16UC3, R G B. Throws SampleError, naming the file,
  /// when it cannot be read whole or differs from the first in size or bits. Safe for many threads.
  cv::Mat read(std::int64_t layer) const;

  /// Of every image; reads the first.
  cv::Size size() const { return size_; }
  int bits() const { return type_ == CV_8UC3 ? 8 : 16; }

 private:
  explicit ImageSequence(std::vector<std::filesystem::path> files);

  std::vector<std::filesystem::path> files_;
  cv::Size size_;
  int type_ = CV_8UC3;
};

}  // namespace biotomy::reconstruct
