#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include <opencv2/core/mat.hpp>

namespace biotomy::reconstruct {

/// Throws InvalidRequest unless the name ends in .mp4, so that work can be refused before it is
/// done.
void check_film_name(const std::filesystem::path& path);

/// A film being written: H.264 in MP4. It appears under its name when it is finished, whole; a film
/// that isn't finished leaves nothing.
class Film {
 public:
  /// Throws InvalidRequest for another extension, an odd or empty frame size or a rate that is not
  /// above 0; SampleError when the film can't be begun.
  Film(std::filesystem::path path, double frames_per_second, cv::Size frame_size);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// CV_8UC3 or CV_16UC3 (cut to 8 bits), R G B, of the film's frame size.
  void add(const cv::Mat& frame);

  /// Throws SampleError when the file does not hold as many frames as were added.
  void finish();

 private:
  struct Writer;

  std::filesystem::path path_;
  std::filesystem::path partial_path_;
  cv::Size frame_size_;
  std::int64_t frames_ = 0;
  std::unique_ptr<Writer> writer_;
};

}  // namespace biotomy::reconstruct
