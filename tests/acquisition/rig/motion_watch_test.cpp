#include "acquisition/rig/motion_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

using bridge::ControllerState;
using std::chrono::milliseconds;
using testing::HasSubstr;

/// A controller that is looked at every 20 ms.
struct Watched {
  MotionWatch watch{SafetyLimits{}};
  bridge::StageStatus status{};
  TimePoint now{};

  explicit Watched(ControllerState state) { status.state = state; }

  void look(milliseconds for_so_long) {
    for (milliseconds passed{0}; passed < for_so_long; passed += milliseconds(20)) {
      now += milliseconds(20);
      watch.observe(status, now);
    }
  }
  std::string cause() const { return watch.cause().value_or(""); }
};

TEST(MotionWatch, IsContentWithAnIdleMachineThatStaysWhereItIs) {
  Watched machine(ControllerState::idle);
  machine.look(milliseconds(60000));
  EXPECT_EQ(machine.cause(), "");
}

TEST(MotionWatch, SeesAColumnThatSinksWhileTheControllerIsIdle) {
  Watched machine(ControllerState::idle);
  machine.status.column = {640.0};
  machine.look(milliseconds(100));
  machine.status.column = {640.0 + SafetyLimits{}.position_tolerance.value + 0.1};
  machine.look(milliseconds(20));
  EXPECT_THAT(machine.cause(), HasSubstr("the column moves by itself"));
  EXPECT_THAT(machine.cause(), HasSubstr("left at 640.0 µm"));
}

TEST(MotionWatch, SeesACreepThatIsSmallBetweenTwoLooks) {
  Watched machine(ControllerState::idle);
  for (int i = 0; i < 200 && machine.cause().empty(); ++i) {
    machine.status.feed.value += 0.1;
    machine.look(milliseconds(20));
  }
  EXPECT_THAT(machine.cause(), HasSubstr("the feed moves by itself"));
}

TEST(MotionWatch, TakesThePlaceAfterACommandAsTheNewOne) {
  Watched machine(ControllerState::idle);
  machine.look(milliseconds(100));
  machine.status.state = ControllerState::busy;
  machine.status.column = machine.status.column_target = {700.0};
  machine.look(milliseconds(100));
  machine.status.state = ControllerState::idle;
  machine.look(milliseconds(100));
  EXPECT_EQ(machine.cause(), "");
}

TEST(MotionWatch, TakesACommandThatBeganAndEndedBetweenTwoLooksForWhatItIs) {
  Watched machine(ControllerState::idle);
  machine.look(milliseconds(100));
  ++machine.status.sequence_started;
  machine.status.column = machine.status.column_target = {525.0};
  machine.look(milliseconds(100));
  EXPECT_EQ(machine.cause(), "");
}

TEST(MotionWatch, SeesAnAxisThatStandsStillOnItsWay) {
  Watched machine(ControllerState::busy);
  machine.status.traverse_target = {150000.0};
  machine.status.air_on = true;  // something else moves
  machine.look(SafetyLimits{}.axis_stall);
  EXPECT_EQ(machine.cause(), "");
  machine.look(milliseconds(60));
  EXPECT_THAT(machine.cause(),
              HasSubstr("the traverse stands still at 0.0 µm on its way to 150000.0"));
}

TEST(MotionWatch, LetsASlowAxisTakeItsTime) {
  Watched machine(ControllerState::busy);
  machine.status.feed_target = {1000.0};
  for (int i = 0; i < 100; ++i) {
    machine.status.feed.value += 10.0;
    machine.look(milliseconds(2000));
    EXPECT_EQ(machine.cause(), "") << i;
  }
}

TEST(MotionWatch, LetsAnAxisWaitAtItsTargetForTheOthers) {
  Watched machine(ControllerState::busy);
  machine.status.feed = machine.status.feed_target = {1000.0};
  machine.status.traverse_target = {150000.0};
  for (int i = 0; i < 100; ++i) {
    machine.status.traverse.value += 1000.0;
    machine.look(milliseconds(1000));
    EXPECT_EQ(machine.cause(), "") << i;
  }
}

TEST(MotionWatch, SeesASpindleThatDoesNotStart) {
  Watched machine(ControllerState::busy);
  machine.look(SafetyLimits{}.standstill);
  EXPECT_EQ(machine.cause(), "");
  machine.look(milliseconds(60));
  EXPECT_THAT(machine.cause(), HasSubstr("nothing moves"));
}

TEST(MotionWatch, IsContentWhileTheSpindleRunsUpOrTheAirBlows) {
  Watched spinning(ControllerState::busy);
  Watched blowing(ControllerState::busy);
  blowing.status.air_on = true;
  for (int i = 0; i < 100; ++i) {
    spinning.status.spindle_rpm += 10.0;
    spinning.look(milliseconds(1000));
    blowing.look(milliseconds(1000));
  }
  EXPECT_EQ(spinning.cause(), "");
  EXPECT_EQ(blowing.cause(), "");
}

TEST(MotionWatch, SaysNothingOfAFaultedControllerThatRetractsByItself) {
  Watched machine(ControllerState::idle);
  machine.look(milliseconds(100));
  machine.status.state = ControllerState::faulted;
  machine.status.feed.value -= 2000.0;
  machine.look(milliseconds(100));
  EXPECT_EQ(machine.cause(), "");
  machine.status.state = ControllerState::idle;
  machine.look(milliseconds(100));
  EXPECT_EQ(machine.cause(), "");
}

TEST(MotionWatch, ForgetsWhereTheAxesWereWhenItIsTold) {
  Watched machine(ControllerState::idle);
  machine.look(milliseconds(100));
  machine.watch.forget();
  machine.status.column.value += 500.0;
  machine.look(milliseconds(100));
  EXPECT_EQ(machine.cause(), "");
}

TEST(MotionWatch, CountsStandstillAndStallFromTheCommandOnAndNotFromTheOneBefore) {
  Watched machine(ControllerState::busy);
  machine.look(milliseconds(1000));
  machine.status.state = ControllerState::idle;
  machine.look(SafetyLimits{}.standstill * 2);
  machine.status.state = ControllerState::busy;
  machine.status.feed_target = {1000.0};
  machine.look(milliseconds(1000));
  EXPECT_EQ(machine.cause(), "");
}

TEST(MotionWatch, SeesAnAxisThatStopsShortOfWhereItIsGoingFromEitherSide) {
  for (const double target : {-1000.0, 1000.0}) {
    Watched machine(ControllerState::busy);
    machine.status.column_target = {target};
    machine.look(SafetyLimits{}.axis_stall + milliseconds(60));
    EXPECT_THAT(machine.cause(), HasSubstr("the column stands still")) << target;
  }
}

TEST(MotionWatch, SeesAnAxisThatLeavesItsPlaceEitherWay) {
  for (const double way : {-6.0, 6.0}) {
    Watched machine(ControllerState::idle);
    machine.look(milliseconds(100));
    machine.status.traverse.value += way;
    machine.look(milliseconds(20));
    EXPECT_THAT(machine.cause(), HasSubstr("the traverse moves by itself")) << way;
  }
}

}  // namespace
}  // namespace biotomy::acquisition
