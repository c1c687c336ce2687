#include "acquisition/calibration/white_balance.hpp"

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "acquisition/calibration/calibration_file.hpp"
#include "acquisition/calibration/fitness.hpp"

namespace biotomy::acquisition {

WhiteBalance white_balance(const MeanFrame& frames, const WhiteBalance& in_force) {
  const cv::Scalar mean = cv::mean(middle_half(frames.mean()));
  return {in_force.red_gain * mean[1] / mean[0], in_force.blue_gain * mean[1] / mean[2]};
}

void write_white_balance(const std::filesystem::path& folder, const WhiteBalance& balance,
                         const bridge::CameraSettings& settings, const std::string& taken_at) {
  write_calibration_file(folder, "white.json",
                         {{"kind", "white"},
                          {"taken_at", taken_at},
                          {"red_gain", balance.red_gain},
                          {"blue_gain", balance.blue_gain},
                          {"taken_with", taken_with(settings)}});
}

}  // namespace biotomy::acquisition
