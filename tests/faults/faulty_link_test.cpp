#include "tests/faults/faulty_link.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/stage/modbus_link.hpp"
#include "sim/control/modbus_server.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace std::chrono_literals;

/// A controller that does nothing, behind the registers of the map.
struct IdleController : sim::ControllerPort {
  bool answers() const override { return true; }
  sim::ControllerReading read() override { return {}; }
  void hear_master(std::uint16_t) override {}
  sim::Acceptance submit(const sim::Command& command) override {
    highest_sequence = std::max(highest_sequence.load(), command.sequence);
    return sim::Acceptance::taken;
  }
  std::atomic<std::uint32_t> highest_sequence = 0;
};

class FaultyLinkTest : public testing::TestWithParam<const char*> {
 protected:
  FaultyLinkTest() {
    const bridge::RegisterMap map = bridge::RegisterMap::read_file(BIOTOMY_REGISTER_MAP);
    const std::string listen =
        over_tcp() ? "tcp://127.0.0.1:0" : "rtu://" + (folder_ / "slave.line").string();
    server_ = sim::make_modbus_server(bridge::parse_endpoint(listen), {}, map, controller_);
    serving_ = std::jthread([this](const std::stop_token& stop) { server_->run(stop); });
    echo_ = map.at("echo").address;
    heartbeat_ = map.at("daemon_heartbeat").address;
    command_ = map.at("command").address;
    version_ = map.version();
  }

  static bool over_tcp() { return GetParam() == std::string("tcp"); }

  bridge::ModbusLinkSettings settings(const std::string& endpoint) const {
    return {.endpoint = endpoint,
            .serial = {.baud = 115200},
            .echo_address = echo_,
            .response_timeout = 30ms,
            .reconnect_delay = 5ms,
            .reconnect_delay_max = 50ms};
  }

  TemporaryFolder folder_;
  IdleController controller_;
  std::unique_ptr<sim::ModbusServer> server_;
  std::jthread serving_;
  int echo_ = 0;
  int heartbeat_ = 0;
  int command_ = 0;
  int version_ = 0;
};

TEST_P(FaultyLinkTest, PassesOnWhatIsSaidWithoutFaults) {
  const FaultyLink line(server_->address(), folder_.path(), {});
  bridge::ModbusLinkSettings patient = settings(line.endpoint());
  patient.response_timeout = 5s;
  patient.echo_address = echo_;
  bridge::ModbusLink link(patient);
  std::array<std::uint16_t, 1> value{};
  for (int i = 0; i < 50; ++i) {
    link.read(bridge::RegisterTable::input, 0, value);
    ASSERT_EQ(value[0], 0xB107);
  }
  EXPECT_GE(line.counts().exchanges, 50);
  EXPECT_EQ(line.counts().all_faults(), 0);
}

// Of two registers side by side, so that the answers to both questions look alike.
TEST_P(FaultyLinkTest, NeverBringsTheAnswerToAnotherQuestion) {
  const FaultyLink line(server_->address(), folder_.path(), LinkFaultPlan::evenly(0.3, 60ms, 4));
  bridge::ModbusLink link(settings(line.endpoint()));
  const auto deadline = std::chrono::steady_clock::now() + 100s;
  int answers = 0;
  while (answers < 80) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << line.counts().text();
    std::array<std::uint16_t, 1> value{};
    try {
      link.read(bridge::RegisterTable::input, answers % 2, value);
    } catch (const bridge::DeviceError& error) {
      EXPECT_NE(error.kind(), bridge::DeviceError::Kind::configuration) << error.what();
      continue;
    }
    ASSERT_EQ(value[0], answers % 2 == 0 ? 0xB107 : version_) << line.counts().text();
    ++answers;
  }
  for (const std::int64_t of_a_kind : line.counts().faults) EXPECT_GT(of_a_kind, 0);
}

// A command of which the end is missing must not be completed by the next message's beginning.
TEST_P(FaultyLinkTest, NeverBringsACommandThatNobodySent) {
  LinkFaultPlan plan{.seed = 7, .share = {}, .longest_delay = 60ms};
  // A command on a serial line needs several good exchanges in a row.
  const double share = over_tcp() ? 0.45 : 0.1;
  plan.share[static_cast<std::size_t>(LinkFault::duplicate)] = share;
  plan.share[static_cast<std::size_t>(LinkFault::truncate)] = share;
  const FaultyLink line(server_->address(), folder_.path(), plan);
  bridge::ModbusLink link(settings(line.endpoint()));
  const auto write = [&](int address, std::initializer_list<std::uint16_t> registers) {
    try {
      link.write(address, std::vector<std::uint16_t>(registers));
      return true;
    } catch (const bridge::DeviceError&) {
      return false;  // also while the link waits before it connects again
    }
  };
  const auto deadline = std::chrono::steady_clock::now() + 100s;
  std::uint32_t number = 0;
  for (int answered = 0; answered < 40;) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << line.counts().text();
    ++number;
    const auto high = static_cast<std::uint16_t>(number >> 16U);
    const auto low = static_cast<std::uint16_t>(number);
    write(heartbeat_, {low});
    // Retract; its number is the last two registers.
    if (write(command_, {3, 0, 0, 0, 0, high, low})) ++answered;
    ASSERT_LE(controller_.highest_sequence, number) << line.counts().text();
  }
  EXPECT_GT(controller_.highest_sequence, 0U);
}

INSTANTIATE_TEST_SUITE_P(Over, FaultyLinkTest, testing::Values("tcp", "rtu"),
                         [](const auto& line) { return std::string(line.param); });

}  // namespace
}  // namespace biotomy::tests
