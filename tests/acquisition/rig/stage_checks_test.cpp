#include "acquisition/rig/stage_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/rig/step_failure.hpp"

namespace biotomy::acquisition {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const SafetyLimits kLimits{};

bridge::StageStatus with_spindle_at(double rpm) {
  bridge::StageStatus status;
  status.spindle_rpm = rpm;
  return status;
}

TEST(StageChecks, TakeAWheelThatTurnsEitherWayForATurningOne) {
  for (const double rpm : {-1500.0, -16.0, 16.0, 1500.0}) {
    EXPECT_FALSE(wheel_stands(with_spindle_at(rpm), kLimits)) << rpm;
    EXPECT_TRUE(wheel_turns(with_spindle_at(rpm), kLimits)) << rpm;
  }
}

TEST(StageChecks, ForgiveAnEncodersNoise) {
  for (const double rpm : {-5.0, 0.0, 5.0}) {
    EXPECT_TRUE(wheel_stands(with_spindle_at(rpm), kLimits)) << rpm;
    EXPECT_FALSE(wheel_turns(with_spindle_at(rpm), kLimits)) << rpm;
  }
  // It does not stand, and what turns so slowly is no alarm.
  for (const double rpm : {-14.0, 14.0}) {
    EXPECT_FALSE(wheel_stands(with_spindle_at(rpm), kLimits)) << rpm;
    EXPECT_FALSE(wheel_turns(with_spindle_at(rpm), kLimits)) << rpm;
  }
}

TEST(StageChecks, SeeAnAxisThatStopsShortAndOneThatGoesTooFar) {
  for (const double position : {970.0, 994.0, 1006.0, 1030.0}) {
    EXPECT_THAT(([&] { check_position("feed", {position}, {1000.0}, kLimits); }),
                ThrowsMessage<StepFailure>(HasSubstr("the feed is at")))
        << position;
  }
  for (const double position : {995.0, 1000.0, 1005.0}) {
    EXPECT_NO_THROW(check_position("feed", {position}, {1000.0}, kLimits)) << position;
  }
}

}  // namespace
}  // namespace biotomy::acquisition
