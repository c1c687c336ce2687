#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/service/notify_section.hpp"
#include "acquisition/service/service_section.hpp"
#include "acquisition/settings/job_settings.hpp"
#include "firmware_bridge/camera/libcamera_camera.hpp"
#include "firmware_bridge/lines/gpiod_lines.hpp"
#include "firmware_bridge/wire/configuration_key.hpp"
#include "firmware_bridge/wire/serial_line.hpp"

namespace biotomy::acquisition {

struct StageConfiguration {
  std::string endpoint;  ///< "tcp://host:port" or "rtu:///dev/name"
  bridge::SerialFormat serial;
  std::filesystem::path register_map;
  std::chrono::milliseconds response_timeout{300};
};

struct LinesConfiguration {
  enum class Backend { socket, gpiod } backend = Backend::socket;
  std::string endpoint;  ///< of the socket: "unix:///path"
  std::chrono::milliseconds response_timeout{200};
  bridge::GpiodLinesSettings gpiod;
};

struct CameraConfiguration {
  enum class Backend { socket, libcamera } backend = Backend::socket;
  std::string endpoint;  ///< of the socket
  std::chrono::milliseconds response_timeout{2000};
  bridge::LibcameraSettings libcamera;
};

/// All of rig.toml.
struct Configuration {
  StageConfiguration stage;
  LinesConfiguration lines;
  CameraConfiguration camera;
  ServiceConfiguration service;
  NotifyConfiguration notify;
  JobSettings job;
};

/// Reads rig.toml. Relative paths in it are relative to its folder. Throws
/// bridge::ConfigurationError: a missing, wrong or unknown key, with the nearest known one.
Configuration read_configuration(const std::filesystem::path& file);

/// The same from text; `source` stands for the file's name.
Configuration parse_configuration(const std::string& text, const std::string& source);

/// The least that rig.toml must say, with the socket back ends.
const char* smallest_configuration();

/// Every key that rig.toml may have, in the order of reading.
std::vector<bridge::DeclaredKey> known_keys();

}  // namespace biotomy::acquisition
