#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "sim/physics/camera.hpp"
#include "sim/service/rig.hpp"
#include "sim/service/rig_server.hpp"
#include "sim/service/witness_log.hpp"

namespace biotomy::sim {

/// Real time, as the camera needs it.
struct CameraTime {
  std::function<std::chrono::steady_clock::time_point()> now;
  std::function<void(std::chrono::microseconds)> wait;  ///< may end early when the twin ends
};

/// The camera behind the rig socket: photographs the rig as it is while the exposure lasts (scaled
/// like all of the rig's time), sends the frame as sealed shared memory and tells the witness how
/// far out of focus it truly was. A camera that hangs answers nothing; one that gives another frame
/// than it took tells the witness.
class CameraService final : public RigServiceHandler {
 public:
  CameraService(std::string model, Camera camera, const CameraOptics& optics, Rig& rig,
                WitnessLog& witness, CameraTime time);

  std::optional<bridge::WelcomeMessage> welcome() override;
  std::optional<bridge::RigAnswer> answer(const bridge::RigMessage& request) override;
  bool present() const override { return !rig_.camera_condition().vanished; }

 private:
  void configure(const bridge::ConfigureMessage& request);
  std::optional<bridge::RigAnswer> capture();
  bridge::RigAnswer photograph(const CameraCondition& condition);
  cv::Mat spoilt(const cv::Mat& image, const CameraCondition& condition) const;

  std::string model_;
  CameraOptics optics_;
  Rig& rig_;
  WitnessLog& witness_;
  CameraTime time_;
  std::mutex using_;  ///< one photograph at a time
  Camera camera_;
  ExposureSettings exposure_;
  cv::Mat last_;  ///< the last photograph that was given as it was
  std::uint64_t last_number_ = 0;
  std::chrono::steady_clock::time_point last_taken_{};
};

}  // namespace biotomy::sim
