#include <array>
#include <fstream>

#include <gtest/gtest.h>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/stage/modbus_link.hpp"
#include "tests/firmware_bridge/stage/serial_slave_in_a_thread.hpp"

namespace biotomy::bridge {
namespace {

using namespace std::chrono_literals;
using testing::SerialSlaveInAThread;
using Kind = DeviceError::Kind;

constexpr int kEchoAddress = 8;
constexpr int kStepping = 2;  // requests to get in step: the echo written, the echo read

class ModbusSerialLinkTest : public ::testing::Test {
 protected:
  /// Long enough for a loaded machine to answer; the tests of silence choose a shorter one.
  void open(std::chrono::milliseconds response_timeout = 5s, int read_retries = 1) {
    link_ = std::make_unique<ModbusLink>(ModbusLinkSettings{.endpoint = slave_.endpoint(),
                                                            .serial = {.baud = 115200},
                                                            .echo_address = kEchoAddress,
                                                            .response_timeout = response_timeout,
                                                            .read_retries = read_retries,
                                                            .reconnect_delay = 100ms},
                                         [this] { return now_; });
  }
  std::uint16_t read(int address) {
    std::array<std::uint16_t, 1> registers{};
    link_->read(RegisterTable::input, address, registers);
    return registers[0];
  }
  void write(int address, std::uint16_t value) {
    link_->write(address, std::array<std::uint16_t, 1>{value});
  }
  template <class Act>
  Kind kind_of_failure(Act act) {
    try {
      act();
    } catch (const DeviceError& error) {
      return error.kind();
    }
    ADD_FAILURE() << "nothing was thrown";
    return Kind::configuration;
  }

  SerialSlaveInAThread slave_;
  std::chrono::steady_clock::time_point now_{};
  std::unique_ptr<ModbusLink> link_;
};

TEST_F(ModbusSerialLinkTest, ReadsAndWritesRegisters) {
  open();
  slave_.input[3] = 1234;
  EXPECT_EQ(read(3), 1234);
  link_->write(5, std::array<std::uint16_t, 2>{7, 8});
  EXPECT_EQ(slave_.holding[5], 7);
  EXPECT_EQ(slave_.holding[6], 8);
}

TEST_F(ModbusSerialLinkTest, GetsInStepOnceAndThenAsksNoMoreThanItMust) {
  open();
  read(0);
  EXPECT_EQ(slave_.requests, kStepping + 1);
  EXPECT_NE(slave_.holding[kEchoAddress], 0);
  write(5, 1);
  read(0);
  EXPECT_EQ(slave_.requests, kStepping + 3);
}

TEST_F(ModbusSerialLinkTest, GetsInStepBetweenTwoQuestionsWhoseAnswersLookAlike) {
  open();
  read(0);
  read(1);
  EXPECT_EQ(slave_.requests, 2 * (kStepping + 1));
}

TEST_F(ModbusSerialLinkTest, BelievesNothingOfALineThatDoesNotGiveTheEchoBack) {
  open(5s, 0);
  slave_.constant_register = kEchoAddress;
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::timeout);
  slave_.constant_register = -1;
  EXPECT_NO_THROW(read(0));
}

TEST_F(ModbusSerialLinkTest, ReadsAgainWhenTheAnswerWasDamaged) {
  open();
  read(0);
  slave_.input[0] = 77;
  write(5, 1);
  slave_.damaged_answers = 1;
  EXPECT_EQ(read(0), 77);
  EXPECT_EQ(slave_.requests, 2 * (kStepping + 1) + 2);
}

TEST_F(ModbusSerialLinkTest, NeverTakesALateAnswerForAnother) {
  open(300ms, 5);
  slave_.input[0] = 1;
  EXPECT_EQ(read(0), 1);
  slave_.withheld_answers = 1;
  slave_.input[1] = 2;
  EXPECT_EQ(kind_of_failure([&] { write(5, 1); }), Kind::timeout);
  slave_.input[0] = 11;
  EXPECT_EQ(read(0), 11);
  slave_.withheld_answers = 1;
  EXPECT_EQ(read(1), 2);
}

TEST_F(ModbusSerialLinkTest, ThrowsASecondCopyOfAnAnswerAway) {
  open();
  slave_.input[0] = 1;
  slave_.input[1] = 2;
  read(0);
  for (int i = 0; i < 10; ++i) {
    slave_.doubled_answers = 1;
    EXPECT_EQ(read(0), 1);
    EXPECT_EQ(read(1), 2);
  }
}

TEST_F(ModbusSerialLinkTest, NeverTriesAWriteAgain) {
  open(300ms, 5);
  read(0);
  slave_.silent_answers = 1;
  EXPECT_EQ(kind_of_failure([&] { write(5, 1); }), Kind::timeout);
  read(0);
  slave_.damaged_answers = 1;
  EXPECT_EQ(kind_of_failure([&] { write(5, 1); }), Kind::timeout);
  EXPECT_EQ(slave_.writes_of_register_5, 2);
}

TEST_F(ModbusSerialLinkTest, BelievesARefusalOnlyWhenItComesTwice) {
  open();
  write(5, 1);
  slave_.exception_answers = 1;
  EXPECT_NO_THROW(read(0));
  slave_.exception_answers = 1;
  EXPECT_NO_THROW(write(5, 1));
  slave_.exception_answers = 2;
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::configuration);
  EXPECT_NO_THROW(read(0));
}

TEST_F(ModbusSerialLinkTest, FailsAtOnceAndSendsNothingWhileADeadLineIsLeftAlone) {
  open(300ms, 0);
  slave_.silent_answers = 1000;
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::timeout);
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::timeout);
  EXPECT_FALSE(link_->connected());
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::disconnected);
  }
  slave_.silent_answers = 0;
  now_ += 100ms;
  EXPECT_NO_THROW(read(0));
  slave_.pull_out();
  EXPECT_EQ(slave_.requests, 2 + kStepping + 1);
}

TEST_F(ModbusSerialLinkTest, FindsTheDeviceAgainThatWasPulledOutAndPutBack) {
  open(100ms);
  slave_.input[0] = 5;
  EXPECT_EQ(read(0), 5);
  slave_.pull_out();
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::disconnected);
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::disconnected);
  slave_.put_back();
  now_ += 1s;
  EXPECT_EQ(read(0), 5);
}

TEST_F(ModbusSerialLinkTest, LeavesALineAloneThatAnotherHas) {
  open();
  read(0);
  ModbusLink second({.endpoint = slave_.endpoint(), .echo_address = kEchoAddress});
  std::array<std::uint16_t, 1> registers{};
  EXPECT_EQ(kind_of_failure([&] { second.read(RegisterTable::input, 0, registers); }),
            Kind::disconnected);
  EXPECT_NO_THROW(read(0));
}

TEST_F(ModbusSerialLinkTest, SaysThatAFileIsNoSerialDevice) {
  const tests::TemporaryFolder folder;
  std::ofstream(folder / "file") << "text";
  ModbusLink link(
      {.endpoint = "rtu://" + (folder / "file").string(), .echo_address = kEchoAddress});
  std::array<std::uint16_t, 1> registers{};
  EXPECT_EQ(kind_of_failure([&] { link.read(RegisterTable::input, 0, registers); }),
            Kind::disconnected);
}

TEST(ModbusSerialLink, RefusesSettingsThatCannotWork) {
  EXPECT_THROW(ModbusLink({.endpoint = "rtu:///dev/ttyUSB0"}), ConfigurationError);
  EXPECT_THROW(ModbusLink({.endpoint = "rtu:///dev/ttyUSB0", .unit_id = 255, .echo_address = 8}),
               ConfigurationError);
}

}  // namespace
}  // namespace biotomy::bridge
