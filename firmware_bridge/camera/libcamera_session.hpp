#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <libcamera/camera.h>
#include <libcamera/camera_manager.h>

#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/camera/camera_sync.hpp"
#include "firmware_bridge/camera/completed_requests.hpp"
#include "firmware_bridge/camera/frame_gate.hpp"
#include "firmware_bridge/camera/libcamera_buffers.hpp"
#include "firmware_bridge/camera/libcamera_camera.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::bridge {

/// The stream stands still, or its requests are cancelled: a new session may help.
class CameraStalled : public std::runtime_error {
 public:
  explicit CameraStalled(const std::string& message) : std::runtime_error(message) {}
};

/// A camera that is acquired and configured, from then until it is let go or unplugged. One thread
/// owns it. Throws DeviceError, and CameraStalled where that is said.
class LibcameraSession {
 public:
  using Clock = CompletedRequests::Clock;

  /// Takes the camera of that id or model. Throws DeviceError of the kind `if_missing` if there is
  /// none.
  LibcameraSession(const LibcameraSettings& settings, CameraSync& sync,
                   DeviceError::Kind if_missing);
  ~LibcameraSession();
  LibcameraSession(const LibcameraSession&) = delete;
  LibcameraSession& operator=(const LibcameraSession&) = delete;

  /// True once the camera was unplugged: it will never work again.
  bool is_gone() { return completed_.is_gone(); }

  const std::string& id() const { return camera_->id(); }
  CameraDescription describe() const;
  void apply(const CameraSettings& settings);

  /// The first frame to be believed. Throws CameraStalled when none at all came for `silence` or
  /// requests were cancelled, DeviceError (timeout) at `deadline`.
  Frame capture(Clock::time_point deadline, std::chrono::milliseconds silence);

 private:
  [[noreturn]] void fail(DeviceError::Kind kind, const std::string& what) const;
  void check(int result, const char* what) const;
  void make_requests();
  void start();
  void queue(libcamera::Request& request);
  void queue_parked();
  void park_completed();
  libcamera::Request& next_request(Clock::time_point deadline, std::chrono::milliseconds silence,
                                   const std::string& last_refusal);
  std::optional<std::string> refusal(libcamera::Request& request);
  Frame frame_of(libcamera::Request& request) const;

  std::shared_ptr<libcamera::CameraManager> manager_;
  std::shared_ptr<libcamera::Camera> camera_;
  CameraSync& sync_;
  bool raw_is_srgb_;
  std::unique_ptr<libcamera::CameraConfiguration> configuration_;
  std::vector<std::unique_ptr<LibcameraBuffers>> buffers_;  ///< of the still, then the viewfinder
  std::vector<std::unique_ptr<libcamera::Request>> requests_;
  std::vector<libcamera::Request*> parked_;       ///< not with libcamera
  std::set<const libcamera::Request*> outdated_;  ///< with libcamera, with settings of before
  bool is_streaming_ = false;
  std::optional<CameraSettings> settings_;
  FrameGate gate_;
  CompletedRequests completed_;
};

}  // namespace biotomy::bridge
