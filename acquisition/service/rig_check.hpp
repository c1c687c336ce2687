#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "acquisition/records/surroundings.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/service/configuration.hpp"
#include "acquisition/service/rig_findings.hpp"
#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/lines/lines.hpp"
#include "firmware_bridge/stage/stage.hpp"

namespace biotomy::acquisition {

/// What a check works with. The devices are made by it, one after the other, so that one which is
/// not there does not hide the others.
struct RigCheckParts {
  std::function<std::shared_ptr<bridge::Stage>()> make_stage;
  std::function<std::shared_ptr<bridge::Lines>()> make_lines;
  std::function<std::shared_ptr<bridge::Camera>()> make_camera;
  Surroundings surroundings;
  std::function<TimePoint()> now;
  std::function<void(std::chrono::milliseconds)> wait;
};

/// The parts that the configuration names.
RigCheckParts real_check_parts(const Configuration& configuration);

/// A dry run of a job's preflight: asks every device what it is and how it is, takes a trial frame,
/// compares plan, sample, disk and clock, and goes on after whatever is wrong.
///
/// Nothing moves: the controller is only read, not even a heartbeat is written to it. The lamp is
/// on for the trial frame when e-stop and door say that nobody is at work on the rig. No file and
/// no folder is made. With a daemon at work on the sample, its devices are left to it.
RigFindings check_rig(const Configuration& configuration, const RigCheckParts& parts);

}  // namespace biotomy::acquisition
