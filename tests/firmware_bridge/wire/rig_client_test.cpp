#include "firmware_bridge/wire/rig_client.hpp"

#include <gtest/gtest.h>

#include "tests/firmware_bridge/fake_rig.hpp"

namespace biotomy::bridge {
namespace {

using namespace std::chrono_literals;
using testing::FakeRig;

RigAnswer inputs(const RigMessage&) {
  return {.message = InputsMessage{false, false}};
}

TEST(RigClient, SaysHelloBeforeItAsks) {
  FakeRig rig(inputs);
  RigClient client(rig.path(), RigService::lines);
  client.ask(ReadInputsMessage{}, 5s);
  client.ask(ReadInputsMessage{}, 5s);
  const auto asked = rig.asked();
  ASSERT_EQ(asked.size(), 3U);
  EXPECT_EQ(std::get<HelloMessage>(asked[0]).service, RigService::lines);
}

TEST(RigClient, StaysConnectedThroughARefusal) {
  FakeRig rig([](const RigMessage&) -> RigAnswer { throw RigRefusal("not today"); });
  RigClient client(rig.path(), RigService::lines);
  EXPECT_THROW(client.ask(ReadInputsMessage{}, 5s), RigRefusal);
  EXPECT_TRUE(client.connected());
}

TEST(RigClient, ConnectsAnewAfterTheRigWasRestarted) {
  FakeRig rig(inputs);
  RigClient client(rig.path(), RigService::lines);
  client.ask(ReadInputsMessage{}, 5s);
  rig.stop();
  EXPECT_THROW(client.ask(ReadInputsMessage{}, 5s), RigSocketError);
  rig.start();
  EXPECT_NO_THROW(client.ask(ReadInputsMessage{}, 5s));
  EXPECT_EQ(client.connect(5s), 2U);
}

TEST(RigClient, DropsTheConnectionAfterATimeOutSoThatNoLateAnswerIsTaken) {
  FakeRig rig(inputs);
  RigClient client(rig.path(), RigService::lines);
  client.connect(5s);
  rig.is_silent = true;
  EXPECT_THROW(client.ask(ReadInputsMessage{}, 5ms), RigSocketError);
  EXPECT_FALSE(client.connected());
}

TEST(RigClient, RefusesAnotherProtocol) {
  FakeRig rig(inputs);
  rig.welcome.protocol = 2;
  RigClient client(rig.path(), RigService::lines);
  EXPECT_THROW(client.connect(5s), MessageError);
  EXPECT_FALSE(client.connected());
}

TEST(RigClient, RefusesACameraThatDoesNotSayWhatItIs) {
  FakeRig rig(inputs);
  rig.welcome.camera.reset();
  RigClient client(rig.path(), RigService::camera);
  EXPECT_THROW(client.connect(5s), MessageError);
}

}  // namespace
}  // namespace biotomy::bridge
