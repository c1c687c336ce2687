#pragma once

#include <memory>

#include "acquisition/focus/focus_actuator.hpp"
#include "acquisition/rig/stage_commands.hpp"
#include "acquisition/settings/job_settings.hpp"
#include "acquisition/worker.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// What a focus actuator works with. All outlive it; the camera belongs to the worker's thread.
struct ActuatorParts {
  StageCommands& commands;
  bridge::Camera& camera;
  Worker& worker;
};

/// The lens of a camera that focuses with it. Throws StepFailure when there is none to drive.
bridge::LensRange lens_of(const bridge::CameraDescription& camera);

/// The one that the configuration names. `settings` outlive it; `column` are the limits of the
/// column as the controller tells them. Throws as `lens_of` does.
std::unique_ptr<FocusActuator> make_focus_actuator(const JobSettings& settings,
                                                   const bridge::AxisLimits& column,
                                                   const bridge::CameraDescription& camera,
                                                   const ActuatorParts& parts);

}  // namespace biotomy::acquisition
