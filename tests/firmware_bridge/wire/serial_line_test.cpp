#include "firmware_bridge/wire/serial_line.hpp"

#include <system_error>

#include <gtest/gtest.h>

#include "firmware_bridge/wire/checked_table.hpp"
#include "sim/control/pseudo_terminal.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::bridge {
namespace {

using std::chrono::microseconds;

TEST(SerialLine, KnowsHowLongCharactersAreOnTheirWay) {
  EXPECT_EQ(SerialFormat{}.duration_of(1920), microseconds(1100000));  // 11 bits each
  const SerialFormat fast{.baud = 115200, .parity = SerialFormat::Parity::none};
  EXPECT_EQ(fast.duration_of(256), microseconds(22222));
}

TEST(SerialLine, PartsFramesByTheSilenceOfTheSpecification) {
  EXPECT_EQ(SerialFormat{.baud = 9600}.silence_between_frames(), microseconds(4010));
  EXPECT_EQ(SerialFormat{.baud = 115200}.silence_between_frames(), microseconds(1750));
}

TEST(SerialLine, IsReadFromTheConfiguration) {
  const SerialFormat format = read_serial_format(
      CheckedTable::parse("baud = 115200\nparity = \"none\"\nstop_bits = 2\n", "rig.toml"));
  EXPECT_EQ(format.baud, 115200);
  EXPECT_EQ(format.parity, SerialFormat::Parity::none);
  EXPECT_EQ(format.stop_bits, 2);
  const SerialFormat usual = read_serial_format(CheckedTable::parse("", "rig.toml"));
  EXPECT_EQ(usual.baud, 19200);
  EXPECT_EQ(usual.parity, SerialFormat::Parity::even);
  EXPECT_EQ(usual.stop_bits, 1);
  EXPECT_THROW(read_serial_format(CheckedTable::parse("baud = 12345\n", "rig.toml")),
               ConfigurationError);
}

TEST(SerialLine, SaysWhyItCannotBeOpened) {
  const auto error_of = [](const std::string& device) {
    try {
      open_serial_line(device, {});
    } catch (const std::system_error& error) {
      return error.code().value();
    }
    return 0;
  };
  const tests::TemporaryFolder folder;
  EXPECT_EQ(error_of(folder / "nothing"), ENOENT);
  EXPECT_EQ(error_of("/dev/null"), ENOTTY);
  const sim::PseudoTerminal terminal(folder / "line");
  const UniqueFd first = open_serial_line(folder / "line", {});
  EXPECT_EQ(error_of(folder / "line"), EWOULDBLOCK);
}

}  // namespace
}  // namespace biotomy::bridge
