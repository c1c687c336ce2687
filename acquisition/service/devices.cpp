#include "acquisition/service/devices.hpp"

#include <utility>

#include "firmware_bridge/camera/libcamera_camera.hpp"
#include "firmware_bridge/camera/socket_camera.hpp"
#include "firmware_bridge/lines/gpiod_lines.hpp"
#include "firmware_bridge/lines/socket_lines.hpp"
#include "firmware_bridge/stage/modbus_link.hpp"
#include "firmware_bridge/stage/modbus_stage.hpp"

namespace biotomy::acquisition {

std::unique_ptr<bridge::Stage> make_stage(const StageConfiguration& configuration) {
  bridge::RegisterMap map = bridge::RegisterMap::read_file(configuration.register_map);
  bridge::ModbusLinkSettings link;
  link.endpoint = configuration.endpoint;
  link.serial = configuration.serial;
  link.unit_id = map.unit_id();
  link.echo_address = map.at("echo").address;
  link.response_timeout = configuration.response_timeout;
  return std::make_unique<bridge::ModbusStage>(std::move(map),
                                               std::make_unique<bridge::ModbusLink>(link));
}

std::unique_ptr<bridge::Lines> make_lines(const LinesConfiguration& configuration) {
  if (configuration.backend == LinesConfiguration::Backend::gpiod) {
    return std::make_unique<bridge::GpiodLines>(configuration.gpiod);
  }
  return std::make_unique<bridge::SocketLines>(configuration.endpoint,
                                               configuration.response_timeout);
}

std::unique_ptr<bridge::Camera> make_camera(const CameraConfiguration& configuration) {
  if (configuration.backend == CameraConfiguration::Backend::libcamera) {
    return std::make_unique<bridge::LibcameraCamera>(configuration.libcamera);
  }
  return std::make_unique<bridge::SocketCamera>(configuration.endpoint,
                                                configuration.response_timeout);
}

Devices await_devices(const Configuration& configuration, DeviceWait& wait) {
  Devices devices;
  devices.stage = wait.device([&] { return make_stage(configuration.stage); });
  if (!devices.stage) return devices;
  devices.lines = wait.device([&] { return make_lines(configuration.lines); });
  if (!devices.lines) return devices;
  devices.camera = wait.device([&] { return make_camera(configuration.camera); });
  return devices;
}

}  // namespace biotomy::acquisition
