#include "acquisition/service/notifications/notice_fold.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::minutes;
using testing::HasSubstr;
using testing::IsEmpty;

struct NoticeFoldTest : testing::Test {
  NoticeFold fold{minutes(15)};
  TimePoint now{std::chrono::hours(1)};

  static Notice trouble(const std::string& text) {
    Notice notice;
    notice.kind = NoticeKind::fault;
    notice.text = text;
    return notice;
  }
  static Notice over() {
    Notice notice = trouble("the alarm was acknowledged");
    notice.over = true;
    return notice;
  }
};

TEST_F(NoticeFoldTest, TellsTheFirstAtOnceAndItsEnd) {
  EXPECT_TRUE(fold.take(trouble("the door is open"), now));
  EXPECT_TRUE(fold.take(over(), now));
  EXPECT_FALSE(fold.take(over(), now));
  EXPECT_FALSE(fold.next_due());
}

TEST_F(NoticeFoldTest, FoldsTheSameCauseIntoOneMessageWithACount) {
  fold.take(trouble("the link was lost for 120 ms"), now);
  fold.take(over(), now);
  for (int i = 0; i < 4; ++i) {
    now += minutes(3);
    EXPECT_FALSE(fold.take(trouble("the link was lost for " + std::to_string(i) + " ms"), now));
    EXPECT_FALSE(fold.take(over(), now));
  }
  EXPECT_THAT(fold.due(now), IsEmpty());
  now += minutes(3);
  EXPECT_EQ(fold.next_due(), now);
  const std::vector<Notice> due = fold.due(now);
  ASSERT_EQ(due.size(), 1U);
  EXPECT_EQ(due[0].count, 4);
  EXPECT_THAT(due[0].text, HasSubstr("(4 more times within 15 min; over now)"));
  EXPECT_THAT(fold.due(now + minutes(60)), IsEmpty());
}

TEST_F(NoticeFoldTest, TellsTheEndOfAFoldedTroubleThatWasTold) {
  fold.take(trouble("a"), now);
  fold.take(over(), now);
  fold.take(trouble("a"), now + minutes(1));
  const std::vector<Notice> due = fold.due(now + minutes(15));
  ASSERT_EQ(due.size(), 1U);
  EXPECT_THAT(due[0].text, testing::Not(HasSubstr("over now")));
  EXPECT_TRUE(fold.take(over(), now + minutes(20)));
}

TEST_F(NoticeFoldTest, TellsAnotherCauseAtOnce) {
  EXPECT_TRUE(fold.take(trouble("the door is open"), now));
  EXPECT_TRUE(fold.take(trouble("the e-stop is pressed"), now));
}

TEST_F(NoticeFoldTest, TellsTheSameCauseAtOnceAfterTheWindow) {
  fold.take(trouble("a"), now);
  fold.take(over(), now);
  EXPECT_TRUE(fold.take(trouble("a"), now + minutes(15)));
}

TEST_F(NoticeFoldTest, GivesUpWhatItCountedWhenTheDaemonEnds) {
  fold.take(trouble("a"), now);
  fold.take(trouble("a"), now);
  EXPECT_EQ(fold.due(now, true).size(), 1U);
}

}  // namespace
}  // namespace biotomy::tests
