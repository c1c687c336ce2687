#pragma once

#include <cstdint>
#include <filesystem>

#include "firmware_bridge/wire/checked_table.hpp"
#include "firmware_bridge/wire/endpoint.hpp"
#include "firmware_bridge/wire/serial_line.hpp"
#include "sim/phantom/phantom.hpp"
#include "sim/physics/camera.hpp"
#include "sim/service/rig.hpp"

namespace biotomy::sim {

/// All of sim.toml. README.md has the table of its keys, made from the code that reads them.
struct Configuration {
  RigSettings rig;
  PhantomSettings phantom;
  double first_face_um = 0;  ///< the feed position at which z = 0 of the phantom lies
  CameraOptics optics;
  SensorSettings sensor;
  std::string camera_model;
  bridge::Endpoint stage_listen;
  bridge::SerialFormat stage_serial;
  std::filesystem::path register_map;
  std::filesystem::path rig_socket;
  std::filesystem::path state_file;
  std::filesystem::path witness_log;
};

/// Throws bridge::ConfigurationError with file, line, key and what was expected.
Configuration read_configuration(const bridge::CheckedTable& file);

/// The table of all keys for README.md, in Markdown.
std::string configuration_reference();

}  // namespace biotomy::sim
