#pragma once

#include <memory>

#include "acquisition/service/configuration.hpp"
#include "acquisition/service/device_wait.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/lines/lines.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// The rig's devices as the configuration names them. Throw ConfigurationError and DeviceError.
std::unique_ptr<bridge::Stage> make_stage(const StageConfiguration& configuration);
std::unique_ptr<bridge::Lines> make_lines(const LinesConfiguration& configuration);
std::unique_ptr<bridge::Camera> make_camera(const CameraConfiguration& configuration);

struct Devices {
  std::unique_ptr<bridge::Stage> stage;
  std::unique_ptr<bridge::Lines> lines;
  std::unique_ptr<bridge::Camera> camera;

  bool are_all_there() const { return stage && lines && camera; }
};

/// All of them, also those that come late. One is missing only when the wait was ended for it.
/// Throws like the above.
Devices await_devices(const Configuration& configuration, DeviceWait& wait);

}  // namespace biotomy::acquisition
