#include "acquisition/rig/parking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/acquisition/rig/rig_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using bridge::StageAction;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct ParkingTest : testing::Test {
  /// A pass of the wheel that does not end by itself.
  void begin_from_motion() {
    rig.stage.exchanges_per_command = 1000;
    rig.commands.begin({.action = StageAction::grind_pass, .spindle_rpm = 1500.0}, rig.now);
    rig.look();
    rig.stage.exchanges_per_command = 2;
    parking.begin(Parking::From::motion, rig.now);
  }
  RigBench rig;
  Parking parking{rig.commands, rig.limits};
};

TEST_F(ParkingTest, StopsWhatMovesAndThenRetracts) {
  begin_from_motion();
  EXPECT_TRUE(rig.finish(parking));
  ASSERT_EQ(rig.stage.executed.size(), 3U);
  EXPECT_EQ(rig.stage.executed[1].command.action, StageAction::stop);
  EXPECT_EQ(rig.stage.executed[2].command.action, StageAction::retract);
  EXPECT_TRUE(rig.finish(parking)) << "and stays parked";
  EXPECT_EQ(rig.stage.executed.size(), 3U);
}

TEST_F(ParkingTest, DoesNotTakeARefusalForAStop) {
  begin_from_motion();
  rig.distort = [](bridge::StageStatus& status) {
    status.last_result = bridge::CommandResult::refused;
  };
  EXPECT_THAT([&] { rig.finish(parking); },
              ThrowsMessage<StepFailure>(HasSubstr("refused to stop")));
  EXPECT_TRUE(parking.waits_for_stop());
  EXPECT_EQ(rig.stage.count(StageAction::retract), 0);
}

// A stop may be answered before the axes stand.
TEST_F(ParkingTest, DoesNotRetractBeforeTheControllerIsIdle) {
  begin_from_motion();
  rig.distort = [](bridge::StageStatus& status) { status.state = bridge::ControllerState::busy; };
  EXPECT_FALSE(rig.finish(parking));
  EXPECT_EQ(rig.stage.count(StageAction::stop), 1);
  EXPECT_EQ(rig.stage.count(StageAction::retract), 0);
  EXPECT_EQ(parking.waiting_for(), "waits for the controller to come to rest");
  rig.distort = [](auto&) {};
  EXPECT_TRUE(rig.finish(parking));
}

TEST_F(ParkingTest, LetsACommandUnderWayEndWhenItBeginsFromRest) {
  rig.commands.begin({.action = StageAction::clear_face}, rig.now);
  parking.begin(Parking::From::rest, rig.now);
  EXPECT_TRUE(rig.finish(parking));
  EXPECT_EQ(rig.stage.count(StageAction::stop), 0);
  EXPECT_EQ(rig.stage.count(StageAction::retract), 1);
}

TEST_F(ParkingTest, TakesNoLongerThanItsLimit) {
  rig.limits.park_limit = std::chrono::milliseconds(200);
  Parking hurried(rig.commands, rig.limits);
  rig.stage.stuck = true;
  hurried.begin(Parking::From::rest, rig.now);
  EXPECT_FALSE(rig.finish(hurried, 10));
  EXPECT_THAT([&] { rig.finish(hurried, 1); },
              ThrowsMessage<StepFailure>(HasSubstr("parking took too long: waits for")));
}

}  // namespace
}  // namespace biotomy::tests
