#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include <opencv2/core/mat.hpp>

#include "reconstruct/disk/file_descriptor.hpp"
#include "reconstruct/section/child_program.hpp"

namespace biotomy::reconstruct {

/// Throws InvalidRequest unless the name ends in .mp4, so that work can be refused before it is
/// done.
void check_film_name(const std::filesystem::path& path);

/// The size of a film of frames of this size, which is even: the same, or as much smaller as
/// players need it. The largest picture of H.264's level 5.2 has 36864 blocks of 16 × 16 pixels,
/// at most 543 along a side (ITU-T H.264, table A-1 and A.3.1); 4096 × 2304, for instance.
cv::Size film_size(cv::Size frame_size);

/// A film being written by the program ffmpeg: H.264 in MP4, 4:2:0, BT.709, the index in front, so
/// that browsers play it while it loads. It appears under its name when it is finished, whole; a
/// film that isn't finished leaves nothing. Only after a kill of our own process a hidden file
/// stays beside it, which the next film of that name replaces.
class Film {
 public:
  /// Throws InvalidRequest for another extension, an odd or empty frame size or a rate that is not
  /// above 0; SampleError when the film can't be begun: no such folder, no ffmpeg, or another
  /// process is writing it.
  Film(std::filesystem::path path, double frames_per_second, cv::Size frame_size);
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// CV_8UC3 or CV_16UC3 (cut to 8 bits), R G B, of the frame size. Throws InvalidRequest for
  /// another size or type, SampleError with ffmpeg's own words when it takes no more.
  void add(const cv::Mat& frame);

  /// Throws SampleError when ffmpeg failed or the file does not hold as many frames as were added.
  void finish();

 private:
  [[noreturn]] void fail();

  std::filesystem::path path_;
  std::filesystem::path partial_path_;
  cv::Size frame_size_;
  std::int64_t frames_ = 0;
  FileDescriptor lock_;
  std::unique_ptr<ChildProgram> encoder_;
};

}  // namespace biotomy::reconstruct
