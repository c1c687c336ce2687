#include "firmware_bridge/stage/serial_ports.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <system_error>
#include <tuple>

#include "firmware_bridge/device_access.hpp"

namespace biotomy::bridge {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> content_of(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  for (const fs::directory_iterator end; !error && entries != end; entries.increment(error)) {
    paths.push_back(entries->path());
  }
  // ttyS2 comes before ttyS10.
  std::ranges::sort(paths, {}, [](const fs::path& path) {
    const std::string name = path.filename().string();
    const std::size_t digits = name.find_last_not_of("0123456789") + 1;
    return std::tuple(name.substr(0, digits), name.size(), name);
  });
  return paths;
}

/// The kernel makes names for ports of the first kind that the board may not have: type 0.
bool is_port(const fs::path& terminal) {
  const std::string name = terminal.filename().string();
  const bool is_serial = name.starts_with("ttyUSB") || name.starts_with("ttyACM") ||
                         name.starts_with("ttyAMA") || name.starts_with("ttyS");
  if (!is_serial) return false;
  std::ifstream file(terminal / "type");
  int type = 0;
  return !(file >> type) || type != 0;
}

bool is_console(const std::string& name, const fs::path& consoles) {
  std::ifstream file(consoles);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string first;
    if (words >> first && first == name) return true;
  }
  return false;
}

std::string trouble_of(const fs::path& device, const SerialPlaces& places) {
  if (is_console(device.filename().string(), places.consoles)) {
    return "the kernel's console is on it: take it out of the kernel's command line and restart";
  }
  if (const auto complaint = access_complaint(device)) return *complaint;
  const std::vector<std::string> programs = programs_with(device, places.processes);
  return programs.empty() ? "" : "it is in use by " + programs.front() + ": stop that first";
}

}  // namespace

std::vector<ListedSerialPort> list_serial_ports(const SerialPlaces& places) {
  std::vector<ListedSerialPort> ports;
  for (const fs::path& terminal : content_of(places.terminals)) {
    if (!is_port(terminal)) continue;
    const fs::path device = places.devices / terminal.filename();
    if (!fs::exists(device)) continue;
    ListedSerialPort port{
        .device = device.string(), .names = {}, .trouble = trouble_of(device, places)};
    for (const char* folder : {"serial/by-id", "serial/by-path"}) {
      for (const fs::path& name : content_of(places.devices / folder)) {
        std::error_code gone;
        if (fs::equivalent(name, device, gone)) port.names.push_back(name.string());
      }
    }
    ports.push_back(std::move(port));
  }
  return ports;
}

}  // namespace biotomy::bridge
