#include "sim/service/twin.hpp"

#include <array>
#include <future>
#include <memory>

#include <gtest/gtest.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include "firmware_bridge/wire/rig_client.hpp"
#include "firmware_bridge/wire/shared_frame.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::sim {
namespace {

using namespace std::chrono_literals;

using Master = std::unique_ptr<modbus_t, void (*)(modbus_t*)>;

/// The twin in a thread, on a free port, a hundred times faster than real.
class TwinTest : public testing::Test {
 protected:
  void SetUp() override {
    configuration_ = read_configuration(bridge::CheckedTable::parse(
        "time_scale = 200\n[stage]\nlisten = \"tcp://127.0.0.1:0\"\nregister_map = \"" BIOTOMY_ROOT
        "/firmware_bridge/register_map.toml\"\n[rig]\nsocket = \"unix://" +
            (folder_ / "rig.sock").string() +
            "\"\n[camera]\nwidth = 96\nheight = 64\npixel = 100\n",
        "sim.toml"));
    twin_ = std::make_unique<Twin>(configuration_);
    running_ = std::async(std::launch::async, [this] { twin_->run(stop_.get_token()); });
  }
  void TearDown() override {
    stop_.request_stop();
    EXPECT_EQ(running_.wait_for(5s), std::future_status::ready);
    running_.get();
  }

  std::uint16_t port() const { return bridge::parse_endpoint(twin_->stage_address()).port; }

  Master master() const {
    Master m(modbus_new_tcp("127.0.0.1", port()), [](modbus_t* context) {
      modbus_close(context);
      modbus_free(context);
    });
    EXPECT_EQ(modbus_connect(m.get()), 0);
    return m;
  }

  bridge::RigClient client(bridge::RigService service) const {
    return {folder_ / "rig.sock", service};
  }

  static std::uint16_t read(const Master& m, int address) {
    std::uint16_t value = 0;
    EXPECT_EQ(modbus_read_input_registers(m.get(), address, 1, &value), 1);
    return value;
  }

  /// Polls, within a generous limit, until an input register has the value.
  static bool comes(const Master& m, int address, std::uint16_t value) {
    const auto limit = std::chrono::steady_clock::now() + 10s;
    while (std::chrono::steady_clock::now() < limit) {
      if (read(m, address) == value) return true;
    }
    return false;
  }

  static int command(const Master& m, std::uint16_t action, std::uint16_t sequence,
                     std::uint16_t position = 0) {
    const std::array<std::uint16_t, 7> block{action, 0, position, 600, 3000, 0, sequence};
    return modbus_write_registers(m.get(), 1, static_cast<int>(block.size()), block.data());
  }

  tests::TemporaryFolder folder_;
  Configuration configuration_;
  std::unique_ptr<Twin> twin_;
  std::stop_source stop_;
  std::future<void> running_;
};

TEST_F(TwinTest, GrindsParksAndShowsTheFaceOverItsSockets) {
  const Master m = master();
  ASSERT_TRUE(comes(m, 2, 1));
  ASSERT_EQ(command(m, 1, 1), 7);
  ASSERT_TRUE(comes(m, 11, 1));
  ASSERT_EQ(command(m, 2, 2, 10000), 7);
  ASSERT_TRUE(comes(m, 11, 2));
  EXPECT_EQ(read(m, 7), 1);
  EXPECT_EQ(read(m, 13), 1);
  ASSERT_EQ(command(m, 3, 3), 7);
  ASSERT_TRUE(comes(m, 11, 3));

  bridge::RigClient lines = client(bridge::RigService::lines);
  lines.ask(bridge::SetOutputMessage{bridge::RigOutput::lamp, true}, 2s);
  bridge::RigClient camera = client(bridge::RigService::camera);
  camera.ask(bridge::ConfigureMessage{.exposure_us = 10000}, 2s);
  EXPECT_EQ(camera.welcome().camera->width, 96);
  const bridge::RigAnswer answer = camera.ask(bridge::CaptureMessage{}, 5s);
  const auto& frame = std::get<bridge::FrameMessage>(answer.message);
  EXPECT_EQ(frame.width, 96);
  EXPECT_EQ(frame.stride, 3 * 96);
  const bridge::MappedFrame pixels(answer.descriptor, 3U * 96U * 64U);
  EXPECT_GT(static_cast<int>(pixels.bytes()[1]), static_cast<int>(pixels.bytes()[0]));  // casting
}

TEST_F(TwinTest, RefusesACommandWhileBusyByABusyException) {
  const Master m = master();
  ASSERT_TRUE(comes(m, 2, 1));
  command(m, 1, 1);
  ASSERT_TRUE(comes(m, 11, 1));
  ASSERT_EQ(command(m, 4, 2, 60000), 7);
  EXPECT_EQ(command(m, 5, 3), -1);
  EXPECT_EQ(errno, EMBXSBUSY);
  ASSERT_TRUE(comes(m, 11, 2));
}

TEST_F(TwinTest, AnswersWhatItCannotDoByModbusExceptions) {
  const Master m = master();
  std::uint16_t value = 7;
  EXPECT_EQ(modbus_read_input_registers(m.get(), 900, 1, &value), -1);
  EXPECT_EQ(errno, EMBXILADD);
  EXPECT_EQ(modbus_write_register(m.get(), 20, 1), -1);
  EXPECT_EQ(errno, EMBXILADD);
  EXPECT_EQ(modbus_write_register(m.get(), 6, 1), -1);  // half of the sequence number
  EXPECT_EQ(errno, EMBXILADD);
  EXPECT_EQ(modbus_write_bit(m.get(), 0, 1), -1);
  EXPECT_EQ(errno, EMBXILFUN);
  EXPECT_EQ(read(m, 0), 0xB107);
}

TEST_F(TwinTest, LosesAClientThatTalksNonsenseAndKeepsTheOthers) {
  const Master good = master();
  const Master half = master();
  const Master bad = master();
  const std::array<std::uint8_t, 5> beginning{0, 1, 0, 0, 0};
  ASSERT_EQ(send(modbus_get_socket(half.get()), beginning.data(), beginning.size(), 0), 5);
  const std::string nonsense = "GET / HTTP/1.1\r\n\r\n";
  ASSERT_GT(send(modbus_get_socket(bad.get()), nonsense.data(), nonsense.size(), 0), 0);
  char byte = 0;
  pollfd hung_up{modbus_get_socket(bad.get()), POLLIN, 0};
  ASSERT_EQ(poll(&hung_up, 1, 5000), 1);
  // A reset where a part of the nonsense was left unread.
  const ssize_t received = recv(modbus_get_socket(bad.get()), &byte, 1, 0);
  EXPECT_TRUE(received == 0 || (received == -1 && errno == ECONNRESET)) << received;
  EXPECT_EQ(read(good, 0), 0xB107);
}

TEST_F(TwinTest, LetsTheBenchPressTheEstopForLinesAndController) {
  bridge::RigClient bench = client(bridge::RigService::bench);
  bench.ask(bridge::SetInputMessage{bridge::RigInput::estop, true}, 2s);
  bridge::RigClient lines = client(bridge::RigService::lines);
  const auto inputs =
      std::get<bridge::InputsMessage>(lines.ask(bridge::ReadInputsMessage{}, 2s).message);
  EXPECT_TRUE(inputs.estop_pressed);
  EXPECT_FALSE(inputs.door_open);
  const Master m = master();
  EXPECT_TRUE(comes(m, 3, 1));
  EXPECT_EQ(read(m, 4) & 1, 1);
}

TEST_F(TwinTest, RefusesRequestsOfAnotherServiceAndGoesOn) {
  bridge::RigClient lines = client(bridge::RigService::lines);
  EXPECT_THROW(lines.ask(bridge::CaptureMessage{}, 2s), bridge::RigRefusal);
  EXPECT_NO_THROW(lines.ask(bridge::ReadInputsMessage{}, 2s));
  bridge::RigClient camera = client(bridge::RigService::camera);
  EXPECT_THROW(camera.ask(bridge::ConfigureMessage{.exposure_us = 0}, 2s), bridge::RigRefusal);
}

TEST_F(TwinTest, SaysSoWhenItsPortIsTaken) {
  Configuration second = configuration_;
  second.stage_listen.port = port();
  second.rig_socket = folder_ / "second.sock";
  try {
    const Twin twin(second);
    FAIL() << "two twins on one port";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("stage.listen"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace biotomy::sim
