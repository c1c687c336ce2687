#pragma once

#include <optional>

#include "acquisition/service/rig_check.hpp"

namespace biotomy::acquisition {

/// What the devices of a rig answered, as far as they did.
struct AnsweredRig {
  std::optional<bridge::StageStatus> controller;
  std::optional<bridge::CameraDescription> camera;  ///< with the calibrations in force
};

/// Asks controller, lines and camera, in this order.
AnsweredRig check_devices(const Configuration& configuration, const RigCheckParts& parts,
                          RigFindings& findings);

}  // namespace biotomy::acquisition
