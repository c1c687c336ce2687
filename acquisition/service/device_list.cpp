#include "acquisition/service/device_list.hpp"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <set>
#include <sstream>
#include <system_error>

#include <nlohmann/json.hpp>

#include "firmware_bridge/device_access.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// The device files that libcamera works with.
std::vector<fs::path> camera_devices() {
  std::vector<fs::path> devices;
  for (const char* folder : {"/dev", "/dev/dma_heap"}) {
    std::error_code error;
    fs::directory_iterator entries(folder, error);
    for (const fs::directory_iterator end; !error && entries != end; entries.increment(error)) {
      const std::string name = entries->path().filename().string();
      const bool belongs_to_cameras = name.starts_with("media") || name.starts_with("video") ||
                                      name.starts_with("v4l-subdev") ||
                                      std::string(folder) == "/dev/dma_heap";
      if (belongs_to_cameras && entries->is_character_file()) devices.push_back(entries->path());
    }
  }
  std::sort(devices.begin(), devices.end());
  return devices;
}

/// libcamera passes over a device that it may not open, without a word; and a camera serves one
/// program at a time.
std::vector<std::string> camera_device_troubles() {
  std::vector<std::string> troubles;
  std::set<std::string> named;
  for (const fs::path& device : camera_devices()) {
    if (const auto complaint = bridge::access_complaint(device)) troubles.push_back(*complaint);
    for (const std::string& program : bridge::programs_with(device)) {
      if (!named.insert(program).second) continue;
      troubles.push_back(device.string() + " is open in " + program +
                         ": only one program at a time can use a camera");
    }
  }
  return troubles;
}

/// One line of what a rig.toml would say.
std::string key_line(const char* key, const std::string& value) {
  return std::string("      ") + key + " = \"" + value + "\"\n";
}

void write_camera(std::ostream& text, const bridge::ListedCamera& camera) {
  text << "  " << camera.model << "\n" << key_line("camera", camera.id);
  if (!camera.trouble.empty()) text << "      TROUBLE: " << camera.trouble << '\n';
  for (const bridge::ListedFormat& format : camera.formats) {
    text << "      pixel_format = \"" << format.name << "\""
         << (format.is_readable ? "" : " (cannot be read by biotomyd)") << ":";
    for (const std::string& size : format.sizes) text << ' ' << size;
    text << '\n';
  }
  for (const bridge::ListedControl& control : camera.controls) {
    text << "      control " << control.name << ": " << control.least << " to " << control.most
         << ", usually " << control.usual << '\n';
  }
}

void write_cameras(std::ostream& text, const DeviceList& devices) {
  text << "cameras, by libcamera " << devices.libcamera << '\n';
  for (const bridge::ListedCamera& camera : devices.cameras) write_camera(text, camera);
  if (devices.cameras.empty()) {
    text << "  none. Is it plugged in, and does the kernel know it (v4l2-ctl --list-devices)? A "
            "camera on a ribbon\n  cable is read once, when the computer starts, and may need a "
            "line in its configuration.\n";
  }
  for (const std::string& trouble : devices.camera_troubles) {
    text << "  TROUBLE: " << trouble << '\n';
  }
}

void write_line(std::ostream& text, std::size_t offset, const bridge::GpioLineInfo& line) {
  text << "      line = " << std::left << std::setw(7) << "\"" + std::to_string(offset) + "\""
       << std::setw(20) << (line.name.empty() ? "no name" : "or \"" + line.name + "\"")
       << (line.is_output ? "output" : "input");
  if (line.is_used) {
    text << ", in use by " << (line.consumer.empty() ? "the kernel" : line.consumer);
  }
  text << '\n';
}

void write_chips(std::ostream& text, const DeviceList& devices) {
  text << "GPIO chips\n";
  for (const auto& [chip, trouble] : devices.chips) {
    text << "  " << chip.name << '\n'
         << key_line("chip", chip.label.empty() ? chip.name : chip.label);
    if (!trouble.empty()) text << "      TROUBLE: " << trouble << '\n';
    for (std::size_t offset = 0; offset < chip.lines.size(); ++offset) {
      write_line(text, offset, chip.lines[offset]);
    }
  }
  if (devices.chips.empty()) {
    text << "  none. This computer has no lines that a program can use, or its kernel has no "
            "driver for them; a USB or\n  I2C expander with a kernel driver would do.\n";
  }
}

void write_ports(std::ostream& text, const DeviceList& devices) {
  text << "serial ports\n";
  for (const bridge::ListedSerialPort& port : devices.ports) {
    text << "  " << port.device << '\n'
         << key_line("endpoint",
                     "rtu://" + (port.names.empty() ? port.device : port.names.front()));
    if (!port.trouble.empty()) text << "      TROUBLE: " << port.trouble << '\n';
  }
  if (devices.ports.empty()) {
    text << "  none. Is the adapter plugged in (dmesg shows it)? A controller on the network needs "
            "none.\n";
  }
}

ordered_json camera_json(const bridge::ListedCamera& camera) {
  ordered_json formats = ordered_json::array();
  for (const bridge::ListedFormat& format : camera.formats) {
    formats.push_back(
        {{"name", format.name}, {"readable", format.is_readable}, {"sizes", format.sizes}});
  }
  ordered_json controls = ordered_json::array();
  for (const bridge::ListedControl& control : camera.controls) {
    controls.push_back({{"name", control.name},
                        {"minimum", control.least},
                        {"maximum", control.most},
                        {"default", control.usual}});
  }
  return {{"id", camera.id},
          {"model", camera.model},
          {"formats", formats},
          {"controls", controls},
          {"trouble", camera.trouble}};
}

ordered_json chip_json(const bridge::ListedGpioChip& listed) {
  const bridge::GpioChipInfo& chip = listed.chip;
  ordered_json lines = ordered_json::array();
  for (std::size_t offset = 0; offset < chip.lines.size(); ++offset) {
    const bridge::GpioLineInfo& line = chip.lines[offset];
    lines.push_back({{"offset", offset},
                     {"name", line.name},
                     {"direction", line.is_output ? "output" : "input"},
                     {"used", line.is_used},
                     {"consumer", line.consumer}});
  }
  return {
      {"name", chip.name}, {"label", chip.label}, {"lines", lines}, {"trouble", listed.trouble}};
}

}  // namespace

DeviceList find_devices() {
  DeviceList devices;
  devices.libcamera = bridge::libcamera_version();
  try {
    devices.cameras = bridge::list_libcamera_cameras();
  } catch (const bridge::DeviceError& error) {
    devices.camera_troubles.emplace_back(error.what());
  }
  for (std::string& trouble : camera_device_troubles()) {
    devices.camera_troubles.push_back(std::move(trouble));
  }
  devices.chips = bridge::list_gpio_chips(*bridge::make_gpio_chips());
  devices.ports = bridge::list_serial_ports();
  return devices;
}

std::string devices_text(const DeviceList& devices) {
  std::ostringstream text;
  write_cameras(text, devices);
  write_chips(text, devices);
  write_ports(text, devices);
  return text.str();
}

std::string devices_json(const DeviceList& devices) {
  ordered_json cameras = ordered_json::array();
  for (const bridge::ListedCamera& camera : devices.cameras) cameras.push_back(camera_json(camera));
  ordered_json chips = ordered_json::array();
  for (const bridge::ListedGpioChip& chip : devices.chips) chips.push_back(chip_json(chip));
  ordered_json ports = ordered_json::array();
  for (const bridge::ListedSerialPort& port : devices.ports) {
    ports.push_back({{"device", port.device}, {"names", port.names}, {"trouble", port.trouble}});
  }
  const ordered_json document{{"libcamera", devices.libcamera},
                              {"cameras", cameras},
                              {"camera_troubles", devices.camera_troubles},
                              {"gpio_chips", chips},
                              {"serial_ports", ports}};
  return document.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace biotomy::acquisition
