#pragma once

#include <cstdint>

#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/stage/stage.hpp"
#include "sim/phantom/phantom.hpp"
#include "sim/physics/axis.hpp"
#include "sim/physics/camera.hpp"
#include "tests/focus/focus_course.hpp"

namespace biotomy::tests {

/// The twin's specimen, camera and column without the rig around them: the part of the world that
/// focusing has to do with.
class TwinOptics {
 public:
  explicit TwinOptics(const FocusCourse& course);

  /// The next face, and what happened to the focal plane meanwhile.
  void begin_layer(int layer);

  sim::Photograph photograph();

  sim::Axis mover;  ///< of the column, or of the lens: its position is that of the plane in focus
  int photographs = 0;

  /// Where the mover would have to stand for the middle of the face to be sharp.
  double sharp_at_um() const;

 private:
  FocusCourse course_;
  sim::Phantom phantom_;
  sim::Camera camera_;
  sim::Block block_;
  double face_um_;
  double wandered_um_ = 0.0;
  double drift_um_ = 0.0;
};

/// Carries out `move_column`, in a time of its own.
class TwinColumn : public bridge::Stage {
 public:
  explicit TwinColumn(TwinOptics& optics) : optics_(optics) {}
  bridge::StageIdentity identify() override;
  bridge::StageStatus look() override;
  bridge::StageStatus exchange(std::uint16_t heartbeat) override;
  void issue(std::uint32_t sequence, const bridge::StageCommand& command) override;

 private:
  TwinOptics& optics_;
  std::uint32_t sequence_ = 0;
};

/// The camera; its lens can be driven when the course says so.
class TwinCamera : public bridge::Camera {
 public:
  TwinCamera(TwinOptics& optics, bool has_lens) : optics_(optics), has_lens_(has_lens) {}
  bridge::CameraDescription describe() override;
  void apply(const bridge::CameraSettings& settings) override;
  bridge::Frame capture(std::chrono::milliseconds time_out) override;

 private:
  TwinOptics& optics_;
  bool has_lens_;
};

}  // namespace biotomy::tests
