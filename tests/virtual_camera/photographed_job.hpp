#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

namespace biotomy::tests {

/// A job of the twin's specimen, and how the daemon begins to focus.
struct PhotographedJob {
  int width = 480;
  int height = 360;
  double pixel_um = 10.0;
  int layers = 8;
  double layer_um = 20.0;
  double focus_guess_error_um = 25.0;  ///< of the position that the first bracket is around
  int second_search_layer = 6;         ///< the daemon searches anew, around where it expects it
  double focus_step_um = 100.0;        ///< of the bracket
  int focus_points = 5;
};

/// The pictures that a camera above the twin's block takes in such a job, in the order in which the
/// daemon takes them: the trial frame of the preflight, before the first pass; then each layer
/// once, in focus, after a bracket with the blur that its positions give, and its confirmation,
/// where the focus is searched.
struct JobPictures {
  std::vector<cv::Mat> all;           ///< CV_8UC3, R, G, B
  std::vector<std::size_t> of_layer;  ///< which of them layer 1, 2, … is
};

JobPictures photograph(const PhotographedJob& job);

}  // namespace biotomy::tests
