#pragma once

#include <memory>

#include "acquisition/service/configuration.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/lines/lines.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// The rig's devices as the configuration names them. Throw ConfigurationError and DeviceError.
std::unique_ptr<bridge::Stage> make_stage(const StageConfiguration& configuration);
std::unique_ptr<bridge::Lines> make_lines(const LinesConfiguration& configuration);
std::unique_ptr<bridge::Camera> make_camera(const CameraConfiguration& configuration);

}  // namespace biotomy::acquisition
