#include "acquisition/service/device_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

DeviceList made_up_devices() {
  DeviceList devices;
  devices.libcamera = "v0.0.3";
  devices.cameras = {
      {.id = "/base/soc/imx477@1a",
       .model = "imx477",
       .formats = {{.name = "SRGGB12_CSI2P", .is_readable = true, .sizes = {"4056x3040"}},
                   {.name = "R8", .is_readable = false, .sizes = {"640x480"}}},
       .controls = {{.name = "ExposureTime", .least = "60", .most = "674181", .usual = "20000"}},
       .trouble = {}}};
  bridge::GpioChipInfo chip{
      .device = "/dev/gpiochip0", .name = "gpiochip0", .label = "pinctrl-bcm2711", .lines = {}};
  chip.lines.resize(18);
  chip.lines[17].name = "GPIO17";
  chip.lines[2] = {.name = "", .is_output = true, .is_used = true, .consumer = "biotomyd"};
  devices.chips = {{.chip = chip, .trouble = {}}};
  devices.ports = {{.device = "/dev/ttyUSB0",
                    .names = {"/dev/serial/by-id/usb-FTDI-42"},
                    .trouble = "it is in use by minicom (process 77): stop that first"}};
  return devices;
}

TEST(DeviceList, ShowsWhatToWriteIntoTheConfiguration) {
  const std::string text = devices_text(made_up_devices());
  EXPECT_THAT(text, HasSubstr("camera = \"/base/soc/imx477@1a\""));
  EXPECT_THAT(text, HasSubstr("pixel_format = \"SRGGB12_CSI2P\": 4056x3040\n"));
  EXPECT_THAT(text, HasSubstr("pixel_format = \"R8\" (cannot be read by biotomyd): 640x480\n"));
  EXPECT_THAT(text, HasSubstr("control ExposureTime: 60 to 674181, usually 20000\n"));
  EXPECT_THAT(text, HasSubstr("chip = \"pinctrl-bcm2711\""));
  EXPECT_THAT(text, HasSubstr("line = \"17\"   or \"GPIO17\"         input\n"));
  EXPECT_THAT(text, HasSubstr("output, in use by biotomyd\n"));
  EXPECT_THAT(text, HasSubstr("endpoint = \"rtu:///dev/serial/by-id/usb-FTDI-42\""));
  EXPECT_THAT(text, HasSubstr("TROUBLE: it is in use by minicom"));
  EXPECT_THAT(text, Not(HasSubstr("none.")));
}

TEST(DeviceList, SaysWhatToDoWhereThereIsNothing) {
  const std::string text = devices_text({});
  EXPECT_THAT(text, AllOf(HasSubstr("none. Is it plugged in"), HasSubstr("none. This computer has"),
                          HasSubstr("none. Is the adapter")));
}

TEST(DeviceList, IsReadByPrograms) {
  const auto json = nlohmann::json::parse(devices_json(made_up_devices()));
  EXPECT_EQ(json.at("cameras")[0].at("formats")[1].at("readable"), false);
  EXPECT_EQ(json.at("cameras")[0].at("controls")[0].at("maximum"), "674181");
  EXPECT_EQ(json.at("gpio_chips")[0].at("lines")[2].at("consumer"), "biotomyd");
  EXPECT_EQ(json.at("serial_ports")[0].at("names")[0], "/dev/serial/by-id/usb-FTDI-42");
}

TEST(DeviceList, CanBeMadeOfThisComputer) {
  EXPECT_THAT(find_devices().libcamera, testing::StartsWith("v"));
}

}  // namespace
}  // namespace biotomy::tests
