#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "firmware_bridge/camera/camera.hpp"

namespace biotomy::acquisition {

/// A camera of which is remembered what it failed at, and what it went through to give a frame:
/// also where asking once more helped, so that the journal tells of a cable that begins to fail,
/// and of a frame that was exposed and never arrived. Belongs to one thread, as every camera does;
/// only `take_troubles` is for others.
class WatchedCamera final : public bridge::Camera {
 public:
  using Time = std::chrono::system_clock::time_point;

  struct Trouble {
    Time at;
    std::string sentence;
  };

  WatchedCamera(bridge::Camera& camera, std::function<Time()> now)
      : camera_(camera), now_(std::move(now)) {}

  bridge::CameraDescription describe() override { return camera_.describe(); }
  void apply(const bridge::CameraSettings& settings) override { camera_.apply(settings); }
  bridge::Frame capture(std::chrono::milliseconds time_out) override;

  /// What went on since this was called before, in order.
  std::vector<Trouble> take_troubles();

 private:
  void note(const std::string& sentence);

  bridge::Camera& camera_;
  std::function<Time()> now_;
  std::mutex mutex_;
  std::vector<Trouble> troubles_;
};

}  // namespace biotomy::acquisition
