#pragma once

#include <string>

#include "acquisition/quality/judgement.hpp"
#include "acquisition/quality/surface_record.hpp"
#include "tests/acquisition/quality/phantom_photographer.hpp"

namespace biotomy::tests {

/// Judges the light and the surface of a specimen's faces as a job does, layer after layer, by the
/// default thresholds. The whole specimen is in view, with casting material round it.
struct SurfaceWatch {
  PhantomPhotographer camera{
      {.width = 512, .height = 512, .pixel_um = 20.0, .left_um = 0.0, .top_um = 0.0}};
  acquisition::SurfaceRecord record;
  acquisition::QualityThresholds thresholds;
  int layer = 0;

  cv::Mat next_face() { return camera.photograph(20.0 * (layer + 1)); }
  acquisition::Assessment judge(const cv::Mat& image) const;
  /// The layer is accepted with this photograph.
  acquisition::Assessment accept(const cv::Mat& image);
  void accept_layers(int count);
};

/// Of a metric that is there.
double value_of(const acquisition::Assessment& assessment, const std::string& metric);
bool is_judged(const acquisition::Assessment& assessment, const std::string& metric);

}  // namespace biotomy::tests
