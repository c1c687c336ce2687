#include "acquisition/job/quality_ladder.hpp"

#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;

TEST(QualityLadder, TakesAgainFocusesAgainClearsAgainAndThenGivesUp) {
  const LadderSettings settings{.max_attempts = 5};
  EXPECT_EQ(after_rejection(1, 0, settings), JobEvent::take_again);
  EXPECT_EQ(after_rejection(2, 0, settings), JobEvent::focus_again);
  EXPECT_EQ(after_rejection(3, 0, settings), JobEvent::clear_again);
  EXPECT_EQ(after_rejection(4, 0, settings), JobEvent::clear_again);
  EXPECT_EQ(after_rejection(5, 0, settings), std::nullopt);
}

TEST(QualityLadder, EndsAtOnceWhenASecondFrameAgreesThatTheFaceDidNotChange) {
  const LadderSettings settings{.max_attempts = 5};
  EXPECT_EQ(after_rejection(1, 1, settings), JobEvent::take_again);
  EXPECT_EQ(after_rejection(2, 2, settings), std::nullopt);
  EXPECT_EQ(after_rejection(3, 1, settings), JobEvent::clear_again);  // the second did not agree
}

}  // namespace
}  // namespace biotomy::tests
