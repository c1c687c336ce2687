#include "acquisition/rig/stage_commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_bridge/device_error.hpp"
#include "tests/acquisition/fake_rig.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using bridge::StageAction;
using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct Bench {
  FakeStage stage;
  SafetyLimits limits;
  StageCommands commands{stage, limits};
  TimePoint now{};

  bool poll() {
    now += milliseconds(20);
    return commands.poll_done(stage.exchange(0), now);
  }
  bool poll_until_done(int ticks = 500) {
    for (int i = 0; i < ticks; ++i) {
      if (poll()) return true;
    }
    return false;
  }
};

TEST(StageCommands, TakeNumbersAboveEveryNumberThatWasUsed) {
  Bench bench;
  bench.commands.raise_to(41);
  bench.commands.raise_to(7);
  EXPECT_EQ(bench.commands.next_sequence(), 42U);
  bench.commands.begin({.action = StageAction::home}, bench.now);
  EXPECT_EQ(bench.stage.executed.back().sequence, 42U);
  EXPECT_TRUE(bench.poll_until_done());
}

TEST(StageCommands, WaitBeforeTheyCountACommandAsNotReceived) {
  Bench bench;
  bench.stage.lost_answer = {StageAction::home, false};
  bench.commands.begin({.action = StageAction::home}, bench.now);
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(bench.poll());  // 400 ms, less than read_back
  EXPECT_EQ(bench.stage.handed_over.size(), 1U);
  EXPECT_TRUE(bench.poll_until_done());
  EXPECT_EQ(bench.stage.handed_over.size(), 2U);
}

TEST(StageCommands, GiveUpAfterTheConfiguredNumberOfAttempts) {
  Bench bench;
  bench.stage.silent = true;
  bench.commands.begin({.action = StageAction::home}, bench.now);
  const bridge::StageStatus status = bench.stage.status;
  const auto poll_for_ever = [&] {
    for (int i = 0; i < 1000; ++i) {
      bench.now += milliseconds(20);
      bench.commands.poll(status, bench.now);
    }
  };
  EXPECT_THAT(poll_for_ever, ThrowsMessage<StepFailure>(HasSubstr("in 10 attempts")));
  EXPECT_EQ(bench.stage.handed_over.size(), 10U);
}

TEST(StageCommands, TellWhenTheControllerRefuses) {
  Bench bench;
  bench.stage.interlocked = true;
  bench.commands.begin({.action = StageAction::home}, bench.now);
  EXPECT_THAT([&] { bench.poll(); }, ThrowsMessage<StepFailure>(HasSubstr("refused")));
}

TEST(StageCommands, TellWhenAStartedCommandIsForgotten) {
  Bench bench;
  bench.stage.exchanges_per_command = 100;
  bench.commands.begin({.action = StageAction::home}, bench.now);
  EXPECT_FALSE(bench.poll());
  bench.stage.status.sequence_started = 0;
  EXPECT_THAT([&] { bench.poll(); }, ThrowsMessage<StepFailure>(HasSubstr("forgot")));
}

TEST(StageCommands, ReadBackWhetherACommandArrivedHoweverTheAnswerWasLost) {
  using Kind = bridge::DeviceError::Kind;
  for (const Kind kind : {Kind::timeout, Kind::disconnected}) {
    for (const bool arrived : {false, true}) {
      Bench bench;
      bench.stage.lost_answer = {StageAction::home, arrived, kind};
      EXPECT_NO_THROW(bench.commands.begin({.action = StageAction::home}, bench.now));
      EXPECT_TRUE(bench.poll_until_done());
      EXPECT_EQ(bench.stage.handed_over.size(), arrived ? 1U : 2U);
      EXPECT_EQ(bench.stage.count(StageAction::home), 1);
    }
  }
}

TEST(StageCommands, AreFinalWhenTheStageSaysNo) {
  using Kind = bridge::DeviceError::Kind;
  for (const Kind kind : {Kind::refused, Kind::configuration}) {
    Bench bench;
    bench.stage.lost_answer = {StageAction::home, false, kind};
    EXPECT_THROW(bench.commands.begin({.action = StageAction::home}, bench.now), StepFailure);
  }
}

TEST(StageCommands, TellWhenACommandThatWasTakenIsNotStarted) {
  Bench bench;
  bench.stage.ignored = StageAction::home;
  bench.commands.begin({.action = StageAction::home}, bench.now);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(bench.poll());  // as long as command_start
  EXPECT_THAT([&] { bench.poll(); }, ThrowsMessage<StepFailure>(HasSubstr("does not start it")));
  EXPECT_EQ(bench.stage.handed_over.size(), 1U);
}

}  // namespace
}  // namespace biotomy::tests
