#include "acquisition/calibration/white_balance.hpp"

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "acquisition/calibration/calibration_record.hpp"
#include "acquisition/calibration/fitness.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/store/durable_file.hpp"

namespace biotomy::acquisition {

WhiteBalance white_balance(const MeanFrame& frames, const WhiteBalance& in_force) {
  const cv::Scalar mean = cv::mean(middle_half(frames.mean()));
  return {in_force.red_gain * mean[1] / mean[0], in_force.blue_gain * mean[1] / mean[2]};
}

void write_white_balance(const std::filesystem::path& folder, const WhiteBalance& balance,
                         const bridge::CameraSettings& settings, const std::string& taken_at) {
  const nlohmann::ordered_json record = {{"kind", "white"},
                                         {"taken_at", taken_at},
                                         {"red_gain", balance.red_gain},
                                         {"blue_gain", balance.blue_gain},
                                         {"taken_with",
                                          {{"exposure_us", settings.exposure.count()},
                                           {"gain", settings.gain},
                                           {"red_gain", settings.red_gain},
                                           {"blue_gain", settings.blue_gain}}}};
  try {
    reconstruct::create_folders_durably(folder);
    reconstruct::write_durably(folder / "white.json", record.dump(2) + "\n");
  } catch (const reconstruct::SampleError& error) {
    throw CalibrationError(std::string("the calibration was not stored: ") + error.what());
  }
}

}  // namespace biotomy::acquisition
