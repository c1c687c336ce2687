#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace biotomy::bridge {

struct ListedSerialPort {
  std::string device;              ///< "/dev/ttyUSB0"
  std::vector<std::string> names;  ///< that stay when it is plugged in anew, those by id first
  std::string trouble;             ///< why it cannot be used now, in words; empty when it can
};

/// Where the kernel and udev show what there is.
struct SerialPlaces {
  std::filesystem::path devices = "/dev";
  std::filesystem::path terminals = "/sys/class/tty";
  std::filesystem::path consoles = "/proc/consoles";
  std::filesystem::path processes = "/proc";
};

/// The serial ports that a controller may be on: USB adapters, and those of the board that have a
/// chip behind them. None is opened: that alone would raise its control lines.
std::vector<ListedSerialPort> list_serial_ports(const SerialPlaces& places = {});

}  // namespace biotomy::bridge
