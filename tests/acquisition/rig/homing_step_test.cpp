#include "acquisition/rig/homing_step.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/acquisition/rig/rig_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct HomingStepTest : testing::Test {
  HomingStepTest() { homing.begin(); }
  RigBench rig;
  HomingStep homing{rig.commands};
};

TEST_F(HomingStepTest, HomesOnce) {
  EXPECT_TRUE(rig.finish(homing));
  EXPECT_EQ(rig.stage.count(bridge::StageAction::home), 1);
}

TEST_F(HomingStepTest, LeavesAxesAloneThatHaveTheirReference) {
  rig.stage.status.interlocks.homed = true;
  EXPECT_TRUE(rig.finish(homing));
  EXPECT_TRUE(rig.stage.executed.empty());
}

TEST_F(HomingStepTest, DoesNotBelieveAHomingAfterWhichTheControllerIsNotHomed) {
  rig.distort = [](bridge::StageStatus& status) { status.interlocks.homed = false; };
  EXPECT_THAT([&] { rig.finish(homing); },
              ThrowsMessage<StepFailure>(HasSubstr("it is not homed")));
}

}  // namespace
}  // namespace biotomy::tests
