#pragma once

#include <string>
#include <vector>

#include "firmware_bridge/camera/libcamera_listing.hpp"
#include "firmware_bridge/lines/gpio_listing.hpp"
#include "firmware_bridge/stage/serial_ports.hpp"

namespace biotomy::acquisition {

/// What there is on this computer that a rig.toml could name.
struct DeviceList {
  std::string libcamera;  ///< its version
  std::vector<bridge::ListedCamera> cameras;
  std::vector<std::string> camera_troubles;  ///< why there may be more than are listed
  std::vector<bridge::ListedGpioChip> chips;
  std::vector<bridge::ListedSerialPort> ports;
};

/// Looks at the computer. Nothing is opened that could notice it, beside cameras by libcamera.
DeviceList find_devices();

/// For people, with what to write into rig.toml, and what to do where nothing was found.
std::string devices_text(const DeviceList& devices);

/// For programs.
std::string devices_json(const DeviceList& devices);

}  // namespace biotomy::acquisition
