#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <opencv2/core/mat.hpp>

namespace biotomy::acquisition {

/// The small pictures of rejected frames in a sample's `rejected/`, for a person to look at. Layer,
/// attempt and reason are in the name: 000012-a03-blurred.jpg. Beyond a number the oldest go.
class RejectedFrames {
 public:
  RejectedFrames(std::filesystem::path folder, int kept, int width_px);

  /// Gives the file's path. Throws SampleError or std::filesystem::filesystem_error.
  std::filesystem::path add(std::int64_t layer, int attempt, const std::string& slug,
                            const cv::Mat& image) const;

 private:
  void remove_oldest() const;

  std::filesystem::path folder_;
  int kept_;
  int width_px_;
};

}  // namespace biotomy::acquisition
