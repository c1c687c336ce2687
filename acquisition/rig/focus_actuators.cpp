#include "acquisition/rig/focus_actuators.hpp"

#include "acquisition/rig/column_actuator.hpp"
#include "acquisition/rig/lens_actuator.hpp"

namespace biotomy::acquisition {

bridge::LensRange lens_of(const bridge::CameraDescription& camera) {
  if (camera.lens) return *camera.lens;
  throw StepFailure("focus.actuator is \"lens\" and the camera \"" + camera.model +
                    "\" has none that can be driven: set it to \"column\"");
}

std::unique_ptr<FocusActuator> make_focus_actuator(const JobSettings& settings,
                                                   const bridge::AxisLimits& column,
                                                   const bridge::CameraDescription& camera,
                                                   const ActuatorParts& parts) {
  if (settings.focus.actuator == FocusSettings::Actuator::column) {
    return std::make_unique<ColumnActuator>(parts.commands, settings.limits, column);
  }
  return std::make_unique<LensActuator>(parts.camera, settings.camera.settings, lens_of(camera),
                                        parts.worker);
}

}  // namespace biotomy::acquisition
