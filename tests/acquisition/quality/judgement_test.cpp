#include "acquisition/quality/judgement.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::SizeIs;

TEST(Judgement, GivesTheReasonOfTheFirstMetricThatFails) {
  Judgement judgement;
  EXPECT_TRUE(judgement.at_least("a", 2.0, 1.0, "too-small", "%.1f is below %.1f"));
  EXPECT_FALSE(judgement.at_most("b", 2.0, 1.0, "too-large", "%.1f is above %.1f"));
  EXPECT_FALSE(judgement.within("c", -2.0, 1.0, "off", "%.1f is more than %.1f"));
  const Assessment found = judgement.finish();
  EXPECT_EQ(found.verdict, Verdict::rejected);
  EXPECT_EQ(found.slug, "too-large");
  EXPECT_EQ(found.reason, "2.0 is above 1.0");
  EXPECT_THAT(found.metrics, SizeIs(3));
}

TEST(Judgement, RejectsWhatHasNoValueAndKeepsNoMetricOfIt) {
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()}) {
    Judgement judgement;
    EXPECT_FALSE(judgement.at_most("drift", value, 1.0, "drifted", "%.1f is above %.1f"));
    const Assessment found = judgement.finish();
    EXPECT_EQ(found.verdict, Verdict::rejected);
    EXPECT_EQ(found.slug, "drifted");
    EXPECT_EQ(found.reason, "drift has no value that could be judged");
    EXPECT_THAT(found.metrics, SizeIs(0));
  }
}

}  // namespace
}  // namespace biotomy::tests
