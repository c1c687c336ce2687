#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/picture/image_file.hpp"
#include "reconstruct/picture/tiff_pages.hpp"

namespace biotomy::reconstruct {

/// How the images of a stack are numbered.
struct ImageNumbering {
  std::int64_t step = 1;  ///< from a layer's number to the next one's, 1 or more
  /// A layer whose number is missing is the one before it once more; else it is an error.
  bool repeats_over_gaps = false;
};

/// Photographs of a stack in the order of the numbers in their names (the last digits in the name:
/// 1, 2, 10, not 1, 10, 2). Layer 1 is the lowest number, whatever it is. Or the pages of one TIFF,
/// in their order.
class ImageSequence {
 public:
  /// `inputs` is one folder, of which the images with a number in the name are taken and the rest
  /// is not looked at, or any number of image files. A TIFF of several pages, alone, needs no
  /// number. Throws SampleError when there is none, when a number is there twice, off the step or,
  /// unless gaps are bridged, missing, or when names differ in more than the number; InvalidRequest
  /// for a numbering where there are pages.
  static ImageSequence find(const std::vector<std::filesystem::path>& inputs,
                            const ImageNumbering& numbering = {});

  std::int64_t count() const { return static_cast<std::int64_t>(files_.size()); }

  /// Of every layer; that of a layer in a gap is there more than once, and so is one of pages.
  const std::vector<std::filesystem::path>& files() const { return files_; }

  /// The layers in gaps, from 1, in order.
  const std::vector<std::int64_t>& repeated() const { return repeated_; }

  /// The image of a layer, from 1, CV_8UC3 or CV_16UC3, R G B. Throws SampleError, naming the file,
  /// when it cannot be read whole or differs from the first in size or bits. Safe for many threads.
  cv::Mat read(std::int64_t layer) const;

  /// Of every image; reads the first.
  cv::Size size() const { return size_; }
  int bits() const { return type_ == CV_8UC3 ? 8 : 16; }

 private:
  ImageSequence(std::vector<std::filesystem::path> files, std::vector<std::int64_t> repeated);
  ImageSequence(const std::filesystem::path& file, std::vector<TiffPage> pages);
  cv::Mat read_any(std::int64_t layer) const;
  void take_size();

  std::vector<std::filesystem::path> files_;
  std::vector<std::int64_t> repeated_;
  std::vector<TiffPage> pages_;  // of the layers, where they are those of one file
  cv::Size size_;
  int type_ = CV_8UC3;
};

}  // namespace biotomy::reconstruct
