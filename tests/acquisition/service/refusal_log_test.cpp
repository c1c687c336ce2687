#include "acquisition/service/refusal_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::seconds;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Optional;

constexpr TimePoint kStart{std::chrono::hours(1)};

TEST(RefusalLog, WritesTheFirstOfAKindAndCountsTheOthers) {
  RefusalLog log;
  EXPECT_EQ(log.line("1.2.3.4", "abort, a wrong token", kStart),
            "refused 1.2.3.4: abort, a wrong token");
  for (int i = 0; i < 500; ++i) {
    EXPECT_FALSE(log.line("1.2.3.4", "abort, a wrong token", kStart + seconds(1)));
  }
  EXPECT_THAT(log.line("1.2.3.4", "abort, a wrong token", kStart + seconds(60)),
              Optional(HasSubstr("500 more refusals before it")));
}

TEST(RefusalLog, WritesTenLinesAMinuteAtMost) {
  RefusalLog log;
  int lines = 0;
  for (int i = 0; i < 100; ++i) {
    if (log.line("10.0.0." + std::to_string(i), "start, no token", kStart)) ++lines;
  }
  EXPECT_EQ(lines, 10);
  EXPECT_THAT(log.line("10.0.1.1", "start, no token", kStart + seconds(61)),
              Optional(EndsWith("90 more refusals before it were not written down")));
}

}  // namespace
}  // namespace biotomy::tests
