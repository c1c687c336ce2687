#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "firmware_bridge/camera/camera.hpp"
#include "firmware_bridge/wire/rig_client.hpp"

namespace biotomy::bridge {

/// A camera in another process, over the rig's socket (wire/README.md). Connects at the first call
/// and, after a failure, at the next; settings applied before are applied again then.
class SocketCamera final : public Camera {
 public:
  /// `time_out` limits every call but capture(), which is given its own.
  SocketCamera(const std::filesystem::path& socket, std::chrono::milliseconds time_out);
  ~SocketCamera() override;

  CameraDescription describe() override;
  void apply(const CameraSettings& settings) override;
  Frame capture(std::chrono::milliseconds time_out) override;

 private:
  std::uint64_t connect(std::chrono::milliseconds time_out);
  void send_settings(std::chrono::milliseconds time_out);

  RigClient client_;
  std::chrono::milliseconds time_out_;
  std::optional<CameraSettings> settings_;
  std::uint64_t configured_connection_ = 0;  ///< the client's connection that has the settings
};

}  // namespace biotomy::bridge
