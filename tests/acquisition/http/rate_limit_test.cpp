#include "acquisition/http/rate_limit.hpp"

#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr RateLimit::TimePoint kStart{std::chrono::hours(1)};

TEST(RateLimit, AllowsSoManyAtOnceAndThenOneAfterEachShareOfAMinute) {
  RateLimit limit = RateLimit::per_minute(6);
  for (int i = 0; i < 6; ++i) EXPECT_FALSE(limit.take("a", kStart)) << i;
  EXPECT_EQ(limit.take("a", kStart), milliseconds(10000));
  EXPECT_EQ(limit.take("a", kStart + seconds(4)), milliseconds(6000));
  EXPECT_FALSE(limit.take("a", kStart + seconds(10)));
  EXPECT_TRUE(limit.take("a", kStart + seconds(10)));
}

TEST(RateLimit, AllowsMoreAtOnceThanInTheLongRun) {
  RateLimit limit(3, milliseconds(20));
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(limit.take("a", kStart)) << i;
  EXPECT_EQ(limit.take("a", kStart), milliseconds(20));
  EXPECT_FALSE(limit.take("a", kStart + milliseconds(20)));
}

TEST(RateLimit, IsWholeAgainAfterAMinute) {
  RateLimit limit = RateLimit::per_minute(3);
  for (int i = 0; i < 3; ++i) limit.take("a", kStart);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(limit.take("a", kStart + minutes(1))) << i;
  EXPECT_TRUE(limit.take("a", kStart + minutes(1)));
}

TEST(RateLimit, CountsEachClientForItself) {
  RateLimit limit = RateLimit::per_minute(1);
  EXPECT_FALSE(limit.take("a", kStart));
  EXPECT_TRUE(limit.take("a", kStart));
  EXPECT_FALSE(limit.take("b", kStart));
}

TEST(RateLimit, DoesNotCountAQuestion) {
  RateLimit limit = RateLimit::per_minute(1);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(limit.wait_of("a", kStart));
  limit.take("a", kStart);
  EXPECT_EQ(limit.wait_of("a", kStart), minutes(1));
}

TEST(RateLimit, StillLimitsTheNewestOfManyClients) {
  RateLimit limit = RateLimit::per_minute(1);
  for (int i = 0; i < 5000; ++i) {
    limit.take(std::to_string(i), kStart + milliseconds(i));
  }
  EXPECT_TRUE(limit.wait_of("4999", kStart + seconds(5)));
  EXPECT_FALSE(limit.wait_of("0", kStart + seconds(5)));  // forgotten, to bound the memory
}

}  // namespace
}  // namespace biotomy::tests
