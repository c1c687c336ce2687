#include "acquisition/service/liveness.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::milliseconds;
using std::chrono::seconds;

struct LivenessTest : testing::Test {
  std::optional<TimePoint> busy_since;
  Liveness liveness{[this] { return busy_since; }, milliseconds(10000)};
  TimePoint now{std::chrono::hours(1)};
};

TEST_F(LivenessTest, NeedsATickForEachSignOfLife) {
  EXPECT_FALSE(liveness.take_progress(now));
  liveness.ticked();
  EXPECT_TRUE(liveness.take_progress(now));
  EXPECT_FALSE(liveness.take_progress(now));
  liveness.ticked();
  liveness.ticked();
  EXPECT_TRUE(liveness.take_progress(now));
  EXPECT_FALSE(liveness.take_progress(now + seconds(3600)));
}

TEST_F(LivenessTest, GivesNoSignWhileTheWorkerHangs) {
  busy_since = now;
  liveness.ticked();
  EXPECT_TRUE(liveness.take_progress(now + seconds(10)));
  liveness.ticked();
  EXPECT_FALSE(liveness.take_progress(now + seconds(11)));
  EXPECT_THAT(liveness.complaint(now + seconds(11)),
              testing::Optional(testing::HasSubstr("for more than 10000 ms")));
  busy_since.reset();
  EXPECT_TRUE(liveness.take_progress(now + seconds(12)));
}

}  // namespace
}  // namespace biotomy::tests
