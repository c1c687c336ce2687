#include "acquisition/service/access.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kAnna = "Bearer 0123456789abcdef";
constexpr const char* kWrong = "Bearer 0123456789abcdeF";

struct AccessTest : testing::Test {
  AccessSettings settings;
  TimePoint now{std::chrono::hours(1)};
  std::vector<std::string> written;

  Access access() {
    return Access(
        Credentials::parse("anna 0123456789abcdef", "token"), settings, [this] { return now; },
        [this](const std::string& line) { written.push_back(line); });
  }
};

TEST_F(AccessTest, LetsInWhoHasAToken) {
  Access door = access();
  const Ruling ruling = door.command("10.0.0.7", kAnna, "start");
  EXPECT_TRUE(ruling.granted);
  EXPECT_EQ(ruling.who, "anna from 10.0.0.7");
  EXPECT_TRUE(written.empty());
}

TEST_F(AccessTest, TurnsAwayWithoutATokenAndWithAWrongOne) {
  Access door = access();
  for (const char* none : {"", "0123456789abcdef", "Basic 0123456789abcdef", "bearer x"}) {
    EXPECT_EQ(door.command("a", none, "start").status, 401) << none;
  }
  for (const char* wrong : {"Bearer ", kWrong, "Bearer 0123456789abcdef0"}) {
    EXPECT_EQ(door.command("a", wrong, "start").status, 403) << wrong;
  }
}

TEST_F(AccessTest, LetsNobodyTryOutTokens) {
  settings.failed_tokens_per_minute = 3;
  Access door = access();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(door.command("a", kWrong, "start").status, 403);
  const Ruling ruling = door.command("a", kAnna, "start");
  EXPECT_EQ(ruling.status, 429);
  EXPECT_EQ(ruling.retry_after, seconds(20));
  EXPECT_THAT(ruling.sentence, HasSubstr("try again in 20 s"));
  EXPECT_TRUE(door.command("b", kAnna, "start").granted);
  now += seconds(20);
  EXPECT_TRUE(door.command("a", kAnna, "start").granted);
}

TEST_F(AccessTest, LimitsTheCommandsOfAnAddress) {
  settings.commands_per_minute = 2;
  Access door = access();
  EXPECT_TRUE(door.command("a", kAnna, "start").granted);
  EXPECT_TRUE(door.command("a", kAnna, "pause").granted);
  const Ruling ruling = door.command("a", kAnna, "resume");
  EXPECT_EQ(ruling.status, 429);
  EXPECT_EQ(ruling.retry_after, seconds(30));
  EXPECT_TRUE(door.command("b", kAnna, "abort").granted);
}

TEST_F(AccessTest, LetsEverybodyReadUnlessReadingNeedsAToken) {
  Access open = access();
  EXPECT_TRUE(open.reading("a", "", "/api/v1/status").granted);
  settings.reading_needs_token = true;
  Access closed = access();
  EXPECT_EQ(closed.reading("a", "", "/api/v1/status").status, 401);
  EXPECT_EQ(closed.reading("a", kWrong, "/api/v1/status").status, 403);
  EXPECT_TRUE(closed.reading("a", kAnna, "/api/v1/status").granted);
}

TEST_F(AccessTest, DoesNotCountReadingAsCommands) {
  settings.reading_needs_token = true;
  settings.commands_per_minute = 1;
  Access door = access();
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(door.reading("a", kAnna, "/metrics").granted);
}

TEST_F(AccessTest, WritesDownTheBeginningAloneOfWhatWasAsked) {
  Access door = access();
  door.command("a", "", "DELETE /api/v1/exports/" + std::string(8000, 'x'));
  ASSERT_EQ(written.size(), 1U);
  EXPECT_THAT(written[0], StartsWith("refused a: DELETE /api/v1/exports/xxx"));
  EXPECT_LT(written[0].size(), 200U);
}

TEST_F(AccessTest, WritesDownRefusalsWithoutTheToken) {
  Access door = access();
  for (int i = 0; i < 50; ++i) door.command("a", kWrong, "abort");
  door.command("a", "", "abort");
  EXPECT_THAT(written, ElementsAre("refused a: abort, a wrong token",
                                   HasSubstr("refused a: abort, too many attempts"),
                                   HasSubstr("refused a: abort, no token")));
}

}  // namespace
}  // namespace biotomy::tests
