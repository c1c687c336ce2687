#include "firmware_bridge/stage/modbus_link.hpp"

#include <array>

#include <gtest/gtest.h>

#include "firmware_bridge/device_error.hpp"
#include "tests/firmware_bridge/stage/slave_in_a_thread.hpp"

namespace biotomy::bridge {
namespace {

using namespace std::chrono_literals;
using testing::SlaveInAThread;
using Kind = DeviceError::Kind;

class ModbusLinkTest : public ::testing::Test {
 protected:
  /// Long enough for a loaded machine to answer; the tests of silence choose a shorter one.
  ModbusLink& open(std::chrono::milliseconds response_timeout = 5s, int read_retries = 1) {
    link_ = std::make_unique<ModbusLink>(ModbusLinkSettings{.endpoint = slave_.endpoint(),
                                                            .response_timeout = response_timeout,
                                                            .read_retries = read_retries,
                                                            .reconnect_delay = 100ms,
                                                            .reconnect_delay_max = 300ms},
                                         [this] { return now_; });
    return *link_;
  }
  std::uint16_t read(int address, RegisterTable table = RegisterTable::input) {
    std::array<std::uint16_t, 1> registers{};
    link_->read(table, address, registers);
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

  SlaveInAThread slave_;
  std::chrono::steady_clock::time_point now_{};
  std::unique_ptr<ModbusLink> link_;
};

TEST_F(ModbusLinkTest, ReadsAndWritesRegisters) {
  open();
  slave_.registers().tab_input_registers[3] = 1234;
  EXPECT_EQ(read(3), 1234);
  link_->write(5, std::array<std::uint16_t, 2>{7, 8});
  EXPECT_EQ(read(5, RegisterTable::holding), 7);
  EXPECT_EQ(read(6, RegisterTable::holding), 8);
  EXPECT_EQ(slave_.connections, 1);
}

TEST_F(ModbusLinkTest, ConnectsAtTheFirstCallOnly) {
  open();
  EXPECT_FALSE(link_->connected());
  read(0);
  EXPECT_TRUE(link_->connected());
}

TEST_F(ModbusLinkTest, TakesRegistersThatAreNotThereForAWrongMapAndStaysConnected) {
  open();
  EXPECT_EQ(kind_of_failure([&] { read(16); }), Kind::configuration);
  EXPECT_EQ(kind_of_failure([&] { write(16, 1); }), Kind::configuration);
  EXPECT_NO_THROW(read(0));
  EXPECT_EQ(slave_.connections, 1);
}

TEST_F(ModbusLinkTest, TakesBusyForARefusalAndStaysConnected) {
  open();
  slave_.is_busy = true;
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::refused);
  slave_.is_busy = false;
  EXPECT_NO_THROW(read(0));
  EXPECT_EQ(slave_.connections, 1);
}

TEST_F(ModbusLinkTest, TriesAReadAgainOnANewConnectionAfterATimeOut) {
  open(100ms, 3);
  read(0);
  slave_.silent_requests = 1;
  EXPECT_NO_THROW(read(0));
  EXPECT_EQ(slave_.connections, 2);
}

TEST_F(ModbusLinkTest, GivesAReadUpAfterItsRetries) {
  open(300ms, 2);
  slave_.silent_requests = 1000;
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::timeout);
  EXPECT_FALSE(link_->connected());
  slave_.stop();
  EXPECT_EQ(slave_.requests, 3);
}

TEST_F(ModbusLinkTest, NeverTriesAWriteAgain) {
  open(300ms, 5);
  slave_.silent_requests = 1000;
  EXPECT_EQ(kind_of_failure([&] { write(0, 1); }), Kind::timeout);
  EXPECT_FALSE(link_->connected());
  slave_.stop();
  EXPECT_EQ(slave_.requests, 1);
}

TEST_F(ModbusLinkTest, ConnectsAnewAtOnceAfterAFirstFailure) {
  open();
  read(0);
  slave_.hangs_up = true;
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::disconnected);
  slave_.hangs_up = false;
  EXPECT_NO_THROW(read(0));
  EXPECT_EQ(slave_.connections, 2);
}

TEST_F(ModbusLinkTest, FailsAtOnceWhileItBacksOffAndConnectsAfterwards) {
  open();
  read(0);
  slave_.hangs_up = true;
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::disconnected);
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::disconnected);
  slave_.hangs_up = false;
  const int before = slave_.connections;
  now_ += 99ms;
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::disconnected);
  EXPECT_EQ(slave_.connections, before);
  now_ += 1ms;
  EXPECT_NO_THROW(read(0));
  EXPECT_EQ(slave_.connections, before + 1);
}

TEST_F(ModbusLinkTest, DoublesTheBackOffUpToItsLimitAndForgetsItAfterAnAnswer) {
  open();
  slave_.hangs_up = true;
  int attempts = 0;
  const auto attempts_within = [&](std::chrono::milliseconds duration) {
    attempts = 0;
    for (auto passed = 0ms; passed < duration; passed += 10ms) {
      const int before = slave_.connections;
      EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::disconnected);
      attempts += slave_.connections - before;
      now_ += 10ms;
    }
    return attempts;
  };
  EXPECT_EQ(attempts_within(1000ms), 6);  // at 0, 10, 110, 310, 610 and 910 ms
  slave_.hangs_up = false;
  now_ += 1s;
  read(0);
  slave_.hangs_up = true;
  EXPECT_EQ(attempts_within(200ms), 2);  // on the open connection at 0, anew at 10 and 110 ms
}

TEST_F(ModbusLinkTest, TellsThatTheSlaveIsGone) {
  open();
  read(0);
  slave_.stop();
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::disconnected);
  now_ += 1s;
  EXPECT_EQ(kind_of_failure([&] { read(0); }), Kind::disconnected);
}

TEST(ModbusLink, RefusesSettingsThatCannotWork) {
  for (const char* endpoint : {"unix:///run/x", "tcp://127.0.0.1:0", "plc"}) {
    EXPECT_THROW(ModbusLink({.endpoint = endpoint}), ConfigurationError) << endpoint;
  }
  EXPECT_THROW(ModbusLink({.endpoint = "tcp://127.0.0.1:502", .unit_id = 0}), ConfigurationError);
  EXPECT_THROW(ModbusLink({.endpoint = "tcp://127.0.0.1:502", .response_timeout = 0ms}),
               ConfigurationError);
}

}  // namespace
}  // namespace biotomy::bridge
