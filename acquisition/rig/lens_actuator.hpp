#pragma once

#include <future>

#include "acquisition/focus/focus_actuator.hpp"
#include "acquisition/worker.hpp"
#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::acquisition {

/// Between the plane in focus and the lens, and back.
double dioptres_at(bridge::Micrometres distance);
bridge::Micrometres distance_of(double dioptres);

/// Between which planes a lens can focus; at most at ten metres.
bridge::AxisLimits lens_limits(const bridge::LensRange& lens);

/// Focuses with a lens that the camera drives. A position is the distance of the plane in focus
/// from the lens, a micrometre to a millionth of the reciprocal of the dioptres. The scale of such
/// lenses is rough; the searches take care of what it is off.
class LensActuator : public FocusActuator {
 public:
  /// `settings` are the camera's others, which stay as they are. The camera is the worker's.
  LensActuator(bridge::Camera& camera, const bridge::CameraSettings& settings,
               bridge::LensRange lens, Worker& worker);

  const char* name() const override { return "lens"; }
  bridge::AxisLimits limits() const override { return lens_limits(lens_); }
  void move_to(bridge::Micrometres target, TimePoint now) override;

  /// The camera itself waits, when it takes the next frame, until its lens has moved.
  bool settled(const bridge::StageStatus& status, TimePoint now) override;
  std::optional<bridge::Micrometres> reported(const bridge::StageStatus& status) const override;
  std::string describe(bridge::Micrometres position) const override;

 private:
  bridge::Camera& camera_;
  bridge::CameraSettings settings_;
  bridge::LensRange lens_;
  Worker& worker_;
  std::future<void> applied_;
};

}  // namespace biotomy::acquisition
