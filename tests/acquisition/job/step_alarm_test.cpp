#include "acquisition/job/step_alarm.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "acquisition/rig/step_failure.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

TEST(AlarmOfAStep, IsTheFailuresOwnOrTheSteps) {
  EXPECT_EQ(alarm_kind_of(DiskFull("no room"), JobState::grinding), AlarmKind::disk);
  EXPECT_EQ(alarm_kind_of(StepFailure("slow", AlarmKind::time_limit), JobState::capturing),
            AlarmKind::time_limit);
  EXPECT_EQ(alarm_kind_of(StepFailure("no peak"), JobState::focusing), AlarmKind::focus);
  EXPECT_EQ(alarm_kind_of(std::runtime_error("no frame"), JobState::capturing), AlarmKind::camera);
  EXPECT_EQ(alarm_kind_of(std::runtime_error("no file"), JobState::storing), AlarmKind::storage);
}

}  // namespace
}  // namespace biotomy::tests
