#include "firmware_bridge/stage/modbus_stage.hpp"

#include <fstream>
#include <limits>
#include <sstream>
#include <vector>

#include <gmock/gmock.h>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/wire/register_codec.hpp"
#include "tests/firmware_bridge/thrown_message.hpp"

namespace biotomy::bridge {
namespace {

using ::testing::HasSubstr;
using Kind = DeviceError::Kind;

/// Micrometres: what a position of 150 mm loses in a float of millimetres.
constexpr double kFloat = 0.01;

/// A controller as two arrays of registers that notes its requests.
struct FakeBus final : RegisterBus {
  struct State {
    std::vector<std::uint16_t> input = std::vector<std::uint16_t>(1100);
    std::vector<std::uint16_t> holding = std::vector<std::uint16_t>(100);
    std::vector<std::string> requests;
    bool write_times_out = false;
  };
  explicit FakeBus(State& to_use) : state(to_use) {}

  void read(RegisterTable table, int address, std::span<std::uint16_t> registers) override {
    state.requests.push_back("read " + std::to_string(address) + " " +
                             std::to_string(registers.size()));
    const auto& source = table == RegisterTable::input ? state.input : state.holding;
    std::copy_n(source.begin() + address, registers.size(), registers.begin());
  }
  void write(int address, std::span<const std::uint16_t> registers) override {
    state.requests.push_back("write " + std::to_string(address) + " " +
                             std::to_string(registers.size()));
    if (state.write_times_out) throw DeviceError(Kind::timeout, "no answer");
    std::copy(registers.begin(), registers.end(), state.holding.begin() + address);
  }

  State& state;
};

std::string map_text() {
  std::ifstream file(BIOTOMY_REGISTER_MAP);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

class ModbusStageBench : public ::testing::Test {
 protected:
  explicit ModbusStageBench(const std::string& map) : map_(RegisterMap::read_file(map)) {
    put("map_magic", 0xB107);
    put("map_version", map_.version());
    put("controller_state", 1);
  }

  void put(const std::string& name, double value) {
    const RegisterEntry& entry = map_.at(name);
    auto& table = entry.table == RegisterTable::input ? state_.input : state_.holding;
    encode(entry, value, std::span(table).subspan(static_cast<std::size_t>(entry.address)));
  }
  double written(const std::string& name) {
    const RegisterEntry& entry = map_.at(name);
    return decode(entry,
                  std::span(state_.holding).subspan(static_cast<std::size_t>(entry.address)));
  }
  std::string refusal_of_map(const std::string& text) {
    return testing::thrown_message<ConfigurationError>([&] {
      ModbusStage stage(RegisterMap::parse(text, "map.toml"), std::make_unique<FakeBus>(state_));
    });
  }

  RegisterMap map_;
  FakeBus::State state_;
  ModbusStage stage_{map_, std::make_unique<FakeBus>(state_)};
};

/// What holds for the reference controller alone.
class ModbusStageTest : public ModbusStageBench {
 protected:
  ModbusStageTest() : ModbusStageBench(BIOTOMY_REGISTER_MAP) {}
};

/// What holds for any controller: another one is another file.
class ModbusStageOfAnyMap : public ModbusStageBench,
                            public ::testing::WithParamInterface<const char*> {
 protected:
  ModbusStageOfAnyMap() : ModbusStageBench(GetParam()) {}
};

INSTANTIATE_TEST_SUITE_P(Of, ModbusStageOfAnyMap,
                         ::testing::Values(BIOTOMY_REGISTER_MAP, BIOTOMY_OTHER_REGISTER_MAP),
                         [](const auto& map) {
                           return map.index == 0 ? "TheReference" : "AnotherController";
                         });

TEST_F(ModbusStageTest, IssuesACommandFromItsFirstRegisterToItsSequence) {
  stage_.issue(1, {.action = StageAction::home});
  EXPECT_THAT(state_.requests, ::testing::ElementsAre("write 1 7"));
}

TEST_F(ModbusStageTest, ExchangesInOneWriteAndOneRead) {
  stage_.exchange(77);
  EXPECT_THAT(state_.requests, ::testing::ElementsAre("write 0 1", "read 2 32"));
  EXPECT_EQ(written("daemon_heartbeat"), 77);
}

TEST_F(ModbusStageTest, LooksWithoutAHeartbeat) {
  stage_.look();
  EXPECT_THAT(state_.requests, ::testing::ElementsAre("read 2 32"));
}

// No two values are alike, so that none can be taken for another.
TEST_P(ModbusStageOfAnyMap, ReportsTheStatusInItsUnits) {
  put("controller_state", 3);
  put("fault_code", 5);
  put("interlocks", 0b1010);
  put("controller_heartbeat", 54321);
  put("command_result", 2);
  put("sequence_started", 4000000000.0);
  put("sequence_finished", 3999999999.0);
  put("grind_count", 12);
  put("feed_position", -1234.5);
  put("traverse_position", 80000.5);
  put("column_position", 612.5);
  put("feed_target", -1200);
  put("traverse_target", 150000.5);
  put("column_target", 33.3);
  put("ground_position", 900.1);
  put("spindle_speed", 1480);
  put("spindle_load", 37.5);
  put("vibration", 2.25);
  put("block_temperature", -40.25);
  put("chamber_temperature", -25.5);
  put("outputs", 2);
  const StageStatus status = stage_.exchange(1);
  EXPECT_EQ(status.state, ControllerState::faulted);
  EXPECT_EQ(status.fault_code, 5);
  EXPECT_FALSE(status.interlocks.estop_pressed);
  EXPECT_TRUE(status.interlocks.door_open);
  EXPECT_FALSE(status.interlocks.watchdog_tripped);
  EXPECT_TRUE(status.interlocks.homed);
  EXPECT_EQ(status.controller_heartbeat, 54321);
  EXPECT_EQ(status.last_result, CommandResult::refused);
  EXPECT_EQ(status.sequence_started, 4000000000U);
  EXPECT_EQ(status.sequence_finished, 3999999999U);
  EXPECT_EQ(status.grind_count, 12U);
  EXPECT_NEAR(status.feed.value, -1234.5, kFloat);
  EXPECT_NEAR(status.traverse.value, 80000.5, kFloat);
  EXPECT_NEAR(status.column.value, 612.5, kFloat);
  EXPECT_NEAR(status.feed_target.value, -1200, kFloat);
  EXPECT_NEAR(status.traverse_target.value, 150000.5, kFloat);
  EXPECT_NEAR(status.column_target.value, 33.3, kFloat);
  EXPECT_NEAR(status.ground_to.value, 900.1, kFloat);
  EXPECT_EQ(status.spindle_rpm, 1480);
  EXPECT_EQ(status.spindle_load_percent, 37.5);
  EXPECT_EQ(status.vibration_mm_s, 2.25);
  EXPECT_EQ(status.block_temperature_c, -40.25);
  EXPECT_EQ(status.chamber_temperature_c, -25.5);
  EXPECT_FALSE(status.coolant_on);
  EXPECT_TRUE(status.air_on);
}

TEST_P(ModbusStageOfAnyMap, TellsTheInterlocksAndOutputsFromOneAnother) {
  for (unsigned int bit = 0; bit < 4; ++bit) {
    put("interlocks", 1U << bit);
    const Interlocks found = stage_.look().interlocks;
    EXPECT_EQ(found.estop_pressed, bit == 0);
    EXPECT_EQ(found.door_open, bit == 1);
    EXPECT_EQ(found.watchdog_tripped, bit == 2);
    EXPECT_EQ(found.homed, bit == 3);
  }
  for (unsigned int bit = 0; bit < 2; ++bit) {
    put("outputs", 1U << bit);
    const StageStatus status = stage_.look();
    EXPECT_EQ(status.coolant_on, bit == 0);
    EXPECT_EQ(status.air_on, bit == 1);
  }
}

TEST_P(ModbusStageOfAnyMap, RefusesACodeThatItDoesNotKnow) {
  put("controller_state", 9);
  EXPECT_THROW(stage_.exchange(1), DeviceError);
}

TEST_P(ModbusStageOfAnyMap, IssuesAWholeCommandInOneWrite) {
  stage_.issue(70000, {.action = StageAction::grind_pass,
                       .position = {1250.3},
                       .duration = std::chrono::milliseconds(1500),
                       .spindle_rpm = 3000});
  ASSERT_EQ(state_.requests.size(), 1U);
  EXPECT_EQ(written("command"), 2);
  EXPECT_NEAR(written("argument_position"), 1250.3, kFloat);
  EXPECT_EQ(written("argument_duration"), 1500);
  EXPECT_EQ(written("argument_spindle"), 3000);
  EXPECT_EQ(written("sequence"), 70000);
}

TEST_P(ModbusStageOfAnyMap, NeverRepeatsACommandThatTimedOut) {
  state_.write_times_out = true;
  EXPECT_THROW(stage_.issue(1, {.action = StageAction::home}), DeviceError);
  EXPECT_EQ(state_.requests.size(), 1U);
}

TEST_P(ModbusStageOfAnyMap, SendsNothingForATargetThatDoesNotFit) {
  for (const double position : {1e44, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(stage_.issue(1, {.action = StageAction::grind_pass, .position = {position}}),
                 DeviceError);
  }
  EXPECT_TRUE(state_.requests.empty());
}

TEST_P(ModbusStageOfAnyMap, IdentifiesTheController) {
  put("watchdog_timeout", 1500);
  put("feed_minimum", -100);
  put("feed_maximum", 50000);
  put("traverse_minimum", -10);
  put("traverse_maximum", 160000);
  put("column_minimum", 20);
  put("column_maximum", 10000);
  const StageIdentity identity = stage_.identify();
  EXPECT_EQ(identity.map_version, map_.version());
  EXPECT_EQ(identity.watchdog_timeout, std::chrono::milliseconds(1500));
  EXPECT_NEAR(identity.feed.minimum.value, -100, kFloat);
  EXPECT_EQ(identity.feed.maximum.value, 50000);
  EXPECT_NEAR(identity.traverse.minimum.value, -10, kFloat);
  EXPECT_EQ(identity.traverse.maximum.value, 160000);
  EXPECT_NEAR(identity.column.minimum.value, 20, kFloat);
  EXPECT_EQ(identity.column.maximum.value, 10000);
}

TEST_P(ModbusStageOfAnyMap, RefusesAControllerWithOtherRegisters) {
  put("map_magic", 1);
  EXPECT_THAT(testing::thrown_message<DeviceError>([&] { stage_.identify(); }),
              HasSubstr("map_magic is 1, expected 45319"));
  put("map_magic", 0xB107);
  put("map_version", map_.version() + 1);
  EXPECT_THAT(testing::thrown_message<DeviceError>([&] { stage_.identify(); }),
              HasSubstr("has version " + std::to_string(map_.version() + 1)));
}

TEST_F(ModbusStageTest, RefusesANegativeNumberWhereThereShouldBeNone) {
  const RegisterMap map =
      RegisterMap::parse(replaced(map_text(), R"(table = "input", address = 3, type = "u16")",
                                  R"(table = "input", address = 3, type = "i16")"),
                         "map.toml");
  ModbusStage stage(map, std::make_unique<FakeBus>(state_));
  state_.input[3] = 0xFFFF;
  EXPECT_THAT(testing::thrown_message<DeviceError>([&] { stage.look(); }),
              HasSubstr("register fault_code holds -1, which it never should"));
}

/// The controller whose positions are floats.
class ModbusStageOfFloats : public ModbusStageBench {
 protected:
  ModbusStageOfFloats() : ModbusStageBench(BIOTOMY_OTHER_REGISTER_MAP) {}
};

TEST_F(ModbusStageOfFloats, RefusesAPositionThatIsNoNumber) {
  const auto at = static_cast<std::size_t>(map_.at("feed_position").address);
  for (const std::uint16_t upper : {0x7FC0, 0x7F80, 0xFF80}) {  // NaN and both infinities
    state_.input[at + 1] = upper;
    EXPECT_THAT(testing::thrown_message<DeviceError>([&] { stage_.look(); }),
                HasSubstr("register feed_position holds no number"));
  }
  state_.input[at + 1] = 0;
  EXPECT_NO_THROW(stage_.look());
}

TEST_F(ModbusStageTest, RefusesAMapThatLacksAName) {
  EXPECT_THAT(refusal_of_map(replaced(map_text(), "grind_count ", "grind_counter ")),
              HasSubstr("registers.grind_count: missing"));
}

TEST_F(ModbusStageTest, RefusesAMapWhoseCommandIsNotOneBlock) {
  EXPECT_THAT(refusal_of_map(replaced(map_text(), R"(table = "holding", address = 6)",
                                      R"(table = "holding", address = 20)")),
              HasSubstr("registers.sequence: must follow argument_spindle without a gap"));
}

TEST_F(ModbusStageTest, RefusesAMapWhoseSequenceComesBeforeAnArgument) {
  std::string text = replaced(map_text(), R"(table = "holding", address = 6, type = "u32")",
                              R"(table = "holding", address = 5, type = "u32")");
  text = replaced(text, R"(table = "holding", address = 5, type = "u16")",
                  R"(table = "holding", address = 7, type = "u16")");
  EXPECT_THAT(refusal_of_map(text), HasSubstr("registers.sequence: must be the last"));
}

TEST_F(ModbusStageTest, RefusesAMapThatScalesACounter) {
  EXPECT_THAT(refusal_of_map(replaced(map_text(), R"(address = 12, type = "u32", scale = 1,)",
                                      R"(address = 12, type = "u32", scale = 2,)")),
              HasSubstr("registers.grind_count: must be an integer with scale 1"));
}

// As i16 it would end the run after 32767 exchanges.
TEST_F(ModbusStageTest, RefusesAMapWhoseHeartbeatCannotHoldEveryNumber) {
  EXPECT_THAT(refusal_of_map(replaced(map_text(), R"(table = "holding", address = 0, type = "u16")",
                                      R"(table = "holding", address = 0, type = "i16")")),
              HasSubstr("registers.daemon_heartbeat: must hold 0 to 65535"));
  EXPECT_THAT(refusal_of_map(replaced(map_text(), R"(table = "input", address = 5, type = "u16")",
                                      R"(table = "input", address = 5, type = "i16")")),
              HasSubstr("registers.controller_heartbeat: must hold 0 to 65535"));
}

TEST_F(ModbusStageTest, RefusesAMapWhoseCommandsAreCountedIn16Bits) {
  EXPECT_THAT(refusal_of_map(replaced(map_text(), R"(table = "holding", address = 6, type = "u32")",
                                      R"(table = "holding", address = 6, type = "u16")")),
              HasSubstr("registers.sequence: must have 32 bits"));
}

TEST_F(ModbusStageTest, RefusesAMapWhoseCommandCannotBeWritten) {
  EXPECT_THAT(refusal_of_map(replaced(
                  map_text(), R"(address = 1, type = "u16", scale = 1, unit = "", access = "w")",
                  R"(address = 1, type = "u16", scale = 1, unit = "", access = "r")")),
              HasSubstr("registers.command: must be a holding register"));
}

}  // namespace
}  // namespace biotomy::bridge
