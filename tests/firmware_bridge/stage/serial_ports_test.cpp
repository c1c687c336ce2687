#include "firmware_bridge/stage/serial_ports.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.hpp"

namespace biotomy::bridge {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A computer as the kernel and udev show it, in a folder.
struct SerialPorts : ::testing::Test {
  tests::TemporaryFolder folder;
  SerialPlaces places{.devices = folder / "dev",
                      .terminals = folder / "sys",
                      .consoles = folder / "consoles",
                      .processes = folder / "proc"};

  SerialPorts() {
    for (const fs::path& made : {places.devices, places.terminals, places.processes}) {
      fs::create_directories(made);
    }
  }

  void add(const std::string& name, const std::string& type = "") const {
    std::ofstream(places.devices / name) << "";
    fs::create_directories(places.terminals / name);
    if (!type.empty()) std::ofstream(places.terminals / name / "type") << type << '\n';
  }

  void link(const std::string& name, const std::string& device) const {
    const fs::path path = places.devices / "serial" / name;
    fs::create_directories(path.parent_path());
    fs::create_symlink(places.devices / device, path);
  }
};

TEST_F(SerialPorts, ListsAdaptersAndPortsOfTheBoardButNoScreens) {
  add("ttyUSB0");
  add("ttyAMA0", "32");
  add("ttyS10", "4");
  add("ttyS2", "4");
  add("tty1");
  add("ptmx");
  std::vector<std::string> devices;
  for (const ListedSerialPort& port : list_serial_ports(places)) {
    devices.push_back(fs::path(port.device).filename());
    EXPECT_EQ(port.trouble, "");
  }
  EXPECT_THAT(devices, ElementsAre("ttyAMA0", "ttyS2", "ttyS10", "ttyUSB0"));
}

TEST_F(SerialPorts, LeavesOutANameWithoutAPortBehindIt) {
  add("ttyS1", "0");
  EXPECT_THAT(list_serial_ports(places), IsEmpty());
}

TEST_F(SerialPorts, GivesTheNamesThatStay) {
  add("ttyUSB0");
  add("ttyUSB1");
  link("by-path/pci-0-usb-1", "ttyUSB1");
  link("by-id/usb-FTDI-42", "ttyUSB1");
  link("by-id/usb-other", "ttyUSB0");
  const auto ports = list_serial_ports(places);
  ASSERT_EQ(ports.size(), 2U);
  EXPECT_THAT(ports[1].names,
              ElementsAre((places.devices / "serial/by-id/usb-FTDI-42").string(),
                          (places.devices / "serial/by-path/pci-0-usb-1").string()));
}

TEST_F(SerialPorts, SaysThatTheConsoleIsOnOne) {
  add("ttyAMA0", "32");
  std::ofstream(places.consoles) << "tty0    -WU (EC  p  )    4:7\nttyAMA0 -W- (EC  p a)  204:64\n";
  ASSERT_EQ(list_serial_ports(places).size(), 1U);
  EXPECT_THAT(list_serial_ports(places)[0].trouble, HasSubstr("the kernel's console is on it"));
}

TEST_F(SerialPorts, SaysWhoHasOne) {
  add("ttyUSB0");
  fs::create_directories(places.processes / "77/fd");
  std::ofstream(places.processes / "77/comm") << "minicom\n";
  fs::create_symlink(fs::canonical(places.devices / "ttyUSB0"), places.processes / "77/fd/3");
  ASSERT_EQ(list_serial_ports(places).size(), 1U);
  EXPECT_EQ(list_serial_ports(places)[0].trouble,
            "it is in use by minicom (process 77): stop that first");
}

TEST_F(SerialPorts, AreNoneWhereThereAreNone) {
  EXPECT_THAT(list_serial_ports({.devices = folder / "none",
                                 .terminals = folder / "none",
                                 .consoles = folder / "none",
                                 .processes = folder / "none"}),
              IsEmpty());
}

}  // namespace
}  // namespace biotomy::bridge
