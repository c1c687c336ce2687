#include "acquisition/job/alarm_kind.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "acquisition/job/step_failure.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

TEST(AlarmKind, HasANameAndAnAdviceOfItsOwn) {
  std::set<std::string> names;
  std::set<std::string> advices;
  constexpr int kKinds = static_cast<int>(AlarmKind::ending) + 1;
  for (int i = 0; i < kKinds; ++i) {
    const auto kind = static_cast<AlarmKind>(i);
    const std::string text = advice(kind);
    names.insert(to_string(kind));
    advices.insert(text);
    EXPECT_TRUE(text.ends_with('.')) << to_string(kind);
    EXPECT_NE(text.find("cknowledge"), std::string::npos) << to_string(kind);
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kKinds));
  EXPECT_EQ(advices.size(), static_cast<std::size_t>(kKinds));
}

TEST(AlarmKind, IsTheFailuresOwnOrTheSteps) {
  EXPECT_EQ(alarm_kind_of(DiskFull("no room"), JobState::grinding), AlarmKind::disk);
  EXPECT_EQ(alarm_kind_of(StepFailure("slow", AlarmKind::time_limit), JobState::capturing),
            AlarmKind::time_limit);
  EXPECT_EQ(alarm_kind_of(StepFailure("no peak"), JobState::focusing), AlarmKind::focus);
  EXPECT_EQ(alarm_kind_of(std::runtime_error("no frame"), JobState::capturing), AlarmKind::camera);
  EXPECT_EQ(alarm_kind_of(std::runtime_error("no file"), JobState::storing), AlarmKind::storage);
}

}  // namespace
}  // namespace biotomy::tests
