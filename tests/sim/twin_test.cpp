#include "sim/service/twin.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <future>
#include <memory>
#include <vector>

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
  EXPECT_EQ(camera.welcome().camera->transfer, bridge::Transfer::linear);
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

TEST_F(TwinTest, BreaksAndMendsForTheBenchWhatAScenarioCanBreak) {
  bridge::RigClient bench = client(bridge::RigService::bench);
  const auto begin = [&](const std::string& name, const std::string& event) {
    return bench.ask(bridge::BeginFaultMessage{name, event}, 2s);
  };
  begin("door", "fault = \"door_open\"");
  bridge::RigClient lines = client(bridge::RigService::lines);
  const auto door_is_open = [&] {
    return std::get<bridge::InputsMessage>(lines.ask(bridge::ReadInputsMessage{}, 2s).message)
        .door_open;
  };
  EXPECT_TRUE(door_is_open());
  bench.ask(bridge::EndFaultMessage{"door"}, 2s);
  EXPECT_FALSE(door_is_open());
  EXPECT_THROW(bench.ask(bridge::EndFaultMessage{"door"}, 2s), bridge::RigRefusal);
  EXPECT_THROW(begin("lamp", "fault = \"lamp_ded\""), bridge::RigRefusal);
}

TEST_F(TwinTest, HasACameraThatHangsVanishesAndComesBack) {
  bridge::RigClient bench = client(bridge::RigService::bench);
  bridge::RigClient camera = client(bridge::RigService::camera);
  const auto failure = [&] {
    try {
      camera.ask(bridge::CaptureMessage{}, 200ms);
    } catch (const bridge::RigSocketError& error) {
      return error.kind();
    }
    return bridge::RigSocketError::Kind::failed;
  };
  camera.ask(bridge::CaptureMessage{}, 5s);
  bench.ask(bridge::BeginFaultMessage{"hang", "fault = \"camera_hangs\"\nlasts = { captures = 2 }"},
            2s);
  EXPECT_EQ(failure(), bridge::RigSocketError::Kind::timeout);
  EXPECT_EQ(failure(), bridge::RigSocketError::Kind::timeout);  // `hello` is not answered, either
  EXPECT_NO_THROW(camera.ask(bridge::CaptureMessage{}, 5s));
  bench.ask(bridge::BeginFaultMessage{"gone", "fault = \"camera_vanishes\""}, 2s);
  EXPECT_EQ(failure(), bridge::RigSocketError::Kind::disconnected);
  EXPECT_EQ(failure(), bridge::RigSocketError::Kind::disconnected);
  bench.ask(bridge::EndFaultMessage{"gone"}, 2s);
  EXPECT_NO_THROW(camera.ask(bridge::CaptureMessage{}, 5s));
}

TEST_F(TwinTest, GivesOldTornBlackAndMissizedFrames) {
  bridge::RigClient bench = client(bridge::RigService::bench);
  bridge::RigClient lines = client(bridge::RigService::lines);
  bridge::RigClient camera = client(bridge::RigService::camera);
  const auto photograph = [&] {
    const bridge::RigAnswer answer = camera.ask(bridge::CaptureMessage{}, 5s);
    const auto& frame = std::get<bridge::FrameMessage>(answer.message);
    const bridge::MappedFrame pixels(answer.descriptor,
                                     static_cast<std::size_t>(frame.stride * frame.height));
    return std::pair(frame, std::vector(pixels.bytes().begin(), pixels.bytes().end()));
  };
  const auto with = [&](const std::string& fault, const std::string& parameters = "") {
    bench.ask(bridge::BeginFaultMessage{"frame", "fault = \"" + fault + "\"\n" + parameters}, 2s);
    auto taken = photograph();
    bench.ask(bridge::EndFaultMessage{"frame"}, 2s);
    return taken;
  };
  lines.ask(bridge::SetOutputMessage{bridge::RigOutput::lamp, true}, 2s);
  const auto [frame, bytes] = photograph();

  const auto [old_frame, old_bytes] = with("camera_old_frame");
  EXPECT_EQ(old_bytes, bytes);
  EXPECT_GT(old_frame.sequence, frame.sequence);

  const auto [older_frame, older_bytes] = with("camera_old_frame", "number = \"old\"");
  EXPECT_EQ(older_bytes, bytes);
  EXPECT_EQ(older_frame.sequence, frame.sequence);
  EXPECT_EQ(older_frame.timestamp_ns, frame.timestamp_ns);

  const auto [torn_frame, torn_bytes] = with("camera_torn_frame");
  const auto half = static_cast<std::ptrdiff_t>(bytes.size() / 2);
  EXPECT_FALSE(std::equal(bytes.begin(), bytes.begin() + half, torn_bytes.begin()));
  EXPECT_TRUE(std::equal(bytes.begin() + half, bytes.end(), torn_bytes.begin() + half));

  const auto [black_frame, black_bytes] = with("camera_black_frame");
  EXPECT_TRUE(std::ranges::all_of(black_bytes, [](std::byte b) { return b == std::byte{0}; }));

  const auto [wrong_frame, wrong_bytes] = with("camera_wrong_size", "width = 60\nheight = 40");
  EXPECT_EQ(wrong_frame.width, 60);
}

TEST_F(TwinTest, FallsSilentOnLinesAndModbus) {
  bridge::RigClient bench = client(bridge::RigService::bench);
  bridge::RigClient lines = client(bridge::RigService::lines);
  lines.ask(bridge::ReadInputsMessage{}, 2s);
  bench.ask(bridge::BeginFaultMessage{"lines", "fault = \"lines_silent\""}, 2s);
  EXPECT_THROW(lines.ask(bridge::ReadInputsMessage{}, 100ms), bridge::RigSocketError);
  bench.ask(bridge::EndFaultMessage{"lines"}, 2s);
  EXPECT_NO_THROW(lines.ask(bridge::ReadInputsMessage{}, 2s));

  const Master m = master();
  modbus_set_response_timeout(m.get(), 0, 100000);
  std::uint16_t value = 0;
  bench.ask(bridge::BeginFaultMessage{"mute", "fault = \"modbus_silent\""}, 2s);
  EXPECT_EQ(modbus_read_input_registers(m.get(), 0, 1, &value), -1);
  EXPECT_EQ(errno, ETIMEDOUT);
  bench.ask(bridge::EndFaultMessage{"mute"}, 2s);
  modbus_set_response_timeout(m.get(), 5, 0);
  EXPECT_EQ(read(m, 0), 0xB107);
}

TEST_F(TwinTest, RefusesRequestsOfAnotherServiceAndGoesOn) {
  bridge::RigClient lines = client(bridge::RigService::lines);
  EXPECT_THROW(lines.ask(bridge::CaptureMessage{}, 2s), bridge::RigRefusal);
  EXPECT_NO_THROW(lines.ask(bridge::ReadInputsMessage{}, 2s));
  bridge::RigClient camera = client(bridge::RigService::camera);
  EXPECT_THROW(camera.ask(bridge::ConfigureMessage{.exposure_us = 0}, 2s), bridge::RigRefusal);
}

TEST_F(TwinTest, AnswersOnASerialLineAsOverTcp) {
  Configuration serial = configuration_;
  serial.stage_listen = bridge::parse_endpoint("rtu://" + (folder_ / "line").string());
  serial.rig_socket = folder_ / "serial.sock";
  std::filesystem::create_symlink("/dev/pts/4000", folder_ / "line");  // a killed twin's
  {
    Twin twin(serial);
    std::stop_source stop;
    std::future<void> running = std::async(std::launch::async, [&] { twin.run(stop.get_token()); });
    const Master m(modbus_new_rtu((folder_ / "line").c_str(), 115200, 'N', 8, 1),
                   [](modbus_t* context) {
                     modbus_close(context);
                     modbus_free(context);
                   });
    modbus_set_slave(m.get(), 1);
    modbus_set_response_timeout(m.get(), 5, 0);
    ASSERT_EQ(modbus_connect(m.get()), 0);
    EXPECT_EQ(read(m, 0), 0xB107);
    ASSERT_TRUE(comes(m, 2, 1));
    ASSERT_EQ(command(m, 1, 1), 7);
    ASSERT_TRUE(comes(m, 11, 1));
    std::uint16_t value = 7;
    EXPECT_EQ(modbus_read_input_registers(m.get(), 900, 1, &value), -1);
    EXPECT_EQ(errno, EMBXILADD);
    EXPECT_EQ(modbus_write_bit(m.get(), 0, 1), -1);
    EXPECT_EQ(errno, EMBXILFUN);
    modbus_set_slave(m.get(), 2);  // nobody
    modbus_set_response_timeout(m.get(), 0, 50000);
    EXPECT_EQ(modbus_read_input_registers(m.get(), 0, 1, &value), -1);
    EXPECT_EQ(errno, ETIMEDOUT);
    stop.request_stop();
    running.get();
  }
  EXPECT_FALSE(std::filesystem::is_symlink(folder_ / "line"));
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
