#include "acquisition/calibration/calibration_file.hpp"

#include <nlohmann/json.hpp>

#include "acquisition/calibration/calibration_record.hpp"
#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"

namespace biotomy::acquisition {

nlohmann::ordered_json taken_with(const bridge::CameraSettings& settings) {
  return {{"exposure_us", settings.exposure.count()},
          {"gain", settings.gain},
          {"red_gain", settings.red_gain},
          {"blue_gain", settings.blue_gain}};
}

void write_calibration_file(const std::filesystem::path& folder, const std::string& name,
                            const nlohmann::ordered_json& record) {
  try {
    reconstruct::create_folders_durably(folder);
    // A camera may name itself in any encoding.
    reconstruct::write_durably(
        folder / name,
        record.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  } catch (const reconstruct::SampleError& error) {
    throw CalibrationError(std::string("the calibration was not stored: ") + error.what());
  }
}

}  // namespace biotomy::acquisition
