#include "acquisition/rig/retraction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/acquisition/rig/rig_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct RetractionTest : testing::Test {
  RetractionTest() { retraction.begin(rig.now); }
  RigBench rig;
  Retraction retraction{rig.commands, rig.limits};
};

TEST_F(RetractionTest, EndsWithTheBlockParkedAndTheWheelStanding) {
  EXPECT_TRUE(rig.finish(retraction));
  EXPECT_EQ(rig.stage.count(bridge::StageAction::retract), 1);
}

TEST_F(RetractionTest, DoesNotBelieveABlockThatIsNotParked) {
  rig.distort = [](bridge::StageStatus& status) { status.traverse = {500.0}; };
  EXPECT_THAT([&] { rig.finish(retraction); },
              ThrowsMessage<StepFailure>(HasSubstr("the traverse is at 500.0 µm")));
}

TEST_F(RetractionTest, WaitsForAWheelThatRunsDown) {
  rig.distort = [](bridge::StageStatus& status) { status.spindle_rpm = -40.0; };
  EXPECT_FALSE(rig.finish(retraction));
  EXPECT_THAT(retraction.waiting_for(), HasSubstr("waits for the wheel to stand"));
  rig.distort = [](auto&) {};
  EXPECT_TRUE(rig.finish(retraction));
}

}  // namespace
}  // namespace biotomy::tests
