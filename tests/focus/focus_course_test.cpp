#include "tests/focus/focus_course.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

class FocusCourseTest : public testing::TestWithParam<FocusCourse> {};

TEST_P(FocusCourseTest, KeepsEveryLayerWithinAQuarterOfTheDepthOfField) {
  FocusCourse course = GetParam();
  course.layers = 32;
  const FocusOutcome outcome = run(course);
  ASSERT_EQ(outcome.misses_um.size(), 32U);
  for (std::size_t i = 0; i < outcome.misses_um.size(); ++i) {
    EXPECT_LT(std::abs(outcome.misses_um[i]), 0.25 * course_depth_of_field_um())
        << "layer " << i + 1;
  }
  EXPECT_LE(outcome.most_frames, 54) << "what nine brackets and their confirmations take";
  EXPECT_LT(outcome.farthest_um, 1200.0);
  EXPECT_LT(outcome.focus_frames, 2 * course.layers);
}

INSTANTIATE_TEST_SUITE_P(Courses, FocusCourseTest, testing::ValuesIn(focus_courses()),
                         [](const auto& course) {
                           return "Course" + std::to_string(course.index + 1);
                         });

}  // namespace
}  // namespace biotomy::tests
