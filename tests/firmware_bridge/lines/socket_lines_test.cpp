#include "firmware_bridge/lines/socket_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_bridge/device_error.hpp"
#include "tests/firmware_bridge/fake_rig.hpp"

namespace biotomy::bridge {
namespace {

using namespace std::chrono_literals;
using testing::FakeRig;

RigAnswer all_well(const RigMessage& request) {
  if (std::holds_alternative<ReadInputsMessage>(request)) {
    return {.message = InputsMessage{.estop_pressed = false, .door_open = false}};
  }
  return {.message = OutputSetMessage{}};
}

bool is_safe(const SafetyInputs& inputs) {
  return !inputs.estop_pressed && !inputs.door_open;
}
bool is_unsafe(const SafetyInputs& inputs) {
  return inputs.estop_pressed && inputs.door_open;
}

TEST(SocketLines, ReportTheInputsAsTheyAre) {
  InputsMessage state{.estop_pressed = false, .door_open = true};
  FakeRig rig([&](const RigMessage&) { return RigAnswer{.message = state, .descriptor = {}}; });
  SocketLines lines(rig.path(), 5s);
  const SafetyInputs inputs = lines.read_inputs();
  EXPECT_FALSE(inputs.estop_pressed);
  EXPECT_TRUE(inputs.door_open);
}

TEST(SocketLines, AreUnsafeWhenNobodyIsThere) {
  const tests::TemporaryFolder folder;
  SocketLines lines(folder / "none.sock", 5s);
  EXPECT_TRUE(is_unsafe(lines.read_inputs()));
  EXPECT_THAT(lines.read_inputs().failure, ::testing::HasSubstr("lines at unix://"));
}

TEST(SocketLines, AreUnsafeWhenThePeerDiesAndSafeAgainWhenItIsBack) {
  FakeRig rig(all_well);
  SocketLines lines(rig.path(), 5s);
  ASSERT_TRUE(is_safe(lines.read_inputs()));
  rig.stop();
  EXPECT_TRUE(is_unsafe(lines.read_inputs()));
  rig.start();
  EXPECT_TRUE(is_safe(lines.read_inputs()));
}

TEST(SocketLines, AreUnsafeWhenThePeerIsSilent) {
  FakeRig rig(all_well);
  rig.is_silent = true;
  SocketLines lines(rig.path(), 5ms);
  EXPECT_TRUE(is_unsafe(lines.read_inputs()));
}

TEST(SocketLines, AreUnsafeWhenTheAnswerIsNotTheOneAskedFor) {
  FakeRig rig([](const RigMessage&) { return RigAnswer{.message = OutputSetMessage{}}; });
  SocketLines lines(rig.path(), 5s);
  EXPECT_TRUE(is_unsafe(lines.read_inputs()));
}

TEST(SocketLines, SetOutputsAndSwitchThemOffAtTheEnd) {
  FakeRig rig(all_well);
  {
    SocketLines lines(rig.path(), 5s);
    lines.set(OutputRole::lamp, true);
    lines.set(OutputRole::trigger, true);
    lines.set(OutputRole::trigger, false);
  }
  const auto asked = rig.asked();
  ASSERT_EQ(asked.size(), 5U);  // hello, three times set, and the lamp off
  const auto last = std::get<SetOutputMessage>(asked.back());
  EXPECT_EQ(last.role, RigOutput::lamp);
  EXPECT_FALSE(last.on);
}

TEST(SocketLines, PassTheRigsRefusalOn) {
  FakeRig rig([](const RigMessage&) -> RigAnswer { throw RigRefusal("the lamp is broken"); });
  SocketLines lines(rig.path(), 5s);
  try {
    lines.set(OutputRole::lamp, true);
    FAIL() << "nothing was thrown";
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.kind(), DeviceError::Kind::refused);
    EXPECT_NE(std::string(error.what()).find("the lamp is broken"), std::string::npos);
  }
}

}  // namespace
}  // namespace biotomy::bridge
