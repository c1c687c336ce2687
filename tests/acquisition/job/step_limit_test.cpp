// Every step of a job may take so long and no longer.
#include <chrono>
#include <functional>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/job/job.hpp"
#include "tests/acquisition/held_job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr double kWarm = -2.0;
constexpr double kRunsDownRpm = 10.0;

struct StepLimit {
  JobState step;
  milliseconds SafetyLimits::*limit;
  /// What besides the limit the step may take.
  std::function<milliseconds(const JobSettings&)> more = [](const auto&) {
    return milliseconds(0);
  };
  /// Why it does not end, if it waits neither for a command nor for the worker.
  std::function<void(JobBench&)> hinder = [](auto&) {};
};

void PrintTo(const StepLimit& limited, std::ostream* out) {
  *out << to_string(limited.step);
}

struct LimitOfAStep : testing::TestWithParam<StepLimit> {
  HeldJobBench bench;
};

TEST_P(LimitOfAStep, StopsTheJobWhenItIsOver) {
  const StepLimit& limited = GetParam();
  bench.settings.limits.*limited.limit = milliseconds(1000);
  const milliseconds whole = milliseconds(1000) + limited.more(bench.settings);
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(limited.step)) << bench.alarm();
  // From now on the worker does nothing, and no command comes to its end.
  bench.stage.stuck = true;
  limited.hinder(bench);
  bench.tick(static_cast<int>(whole / milliseconds(20)));
  EXPECT_EQ(bench.state(), limited.step) << bench.alarm();
  bench.tick();
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_THAT(bench.alarm(), HasSubstr(std::string(to_string(limited.step)) + " took longer than " +
                                       std::to_string(whole.count()) + " ms: it waits for"));
  EXPECT_EQ(bench.board.look()->alarm->kind, AlarmKind::time_limit);
}

std::string step_name(const testing::TestParamInfo<StepLimit>& info) {
  return to_string(info.param.step);
}
INSTANTIATE_TEST_SUITE_P(
    Steps, LimitOfAStep,
    testing::Values(
        StepLimit{.step = JobState::preflight, .limit = &SafetyLimits::preflight_limit},
        StepLimit{.step = JobState::recovering,
                  .limit = &SafetyLimits::recovery_limit,
                  .hinder = [](JobBench& bench) { bench.stage.status.spindle_rpm = kRunsDownRpm; }},
        StepLimit{.step = JobState::homing, .limit = &SafetyLimits::home_limit},
        StepLimit{
            .step = JobState::conditioning,
            .limit = &SafetyLimits::conditioning_limit,
            .hinder = [](JobBench& bench) { bench.stage.status.block_temperature_c = kWarm; }},
        StepLimit{.step = JobState::grinding, .limit = &SafetyLimits::grind_limit},
        StepLimit{.step = JobState::retracting, .limit = &SafetyLimits::retract_limit},
        StepLimit{.step = JobState::clearing,
                  .limit = &SafetyLimits::clear_limit,
                  .more = [](const JobSettings& settings) { return settings.plan.clear_duration; }},
        StepLimit{.step = JobState::focusing, .limit = &SafetyLimits::focus_limit},
        StepLimit{
            .step = JobState::capturing,
            .limit = &SafetyLimits::capture_limit,
            .more =
                [](const JobSettings& settings) { return 2 * settings.camera.capture_time_out; }},
        StepLimit{.step = JobState::assessing, .limit = &SafetyLimits::assess_limit},
        StepLimit{.step = JobState::storing, .limit = &SafetyLimits::store_limit}),
    step_name);

// A job that is held, and a latch that is reset, are reached in ways of their own.

TEST(LimitOfBeingHeld, StopsTheJobWhenItIsOver) {
  JobBench bench;
  bench.settings.limits.disk_resumes = true;
  bench.settings.limits.held_limit = milliseconds(2000);
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  bench.free_bytes = 10;
  ASSERT_TRUE(bench.reach(JobState::held)) << bench.alarm();
  bench.tick(100);
  EXPECT_EQ(bench.state(), JobState::held) << bench.alarm();
  bench.tick();
  EXPECT_THAT(bench.alarm(), HasSubstr("held took longer than 2000 ms: it waits for room"));
}

TEST(LimitOfAReset, ClosesTheLatchAgainWhenItIsOver) {
  JobBench bench;
  bench.settings.limits.reset_limit = milliseconds(2000);
  bench.start_daemon();
  constexpr std::uint16_t kWatchdog = 3;
  bench.stage.fault(kWatchdog);
  bench.stage.stuck = true;
  bench.tick();
  const OperatorReply reply = bench.say(OperatorCommand::acknowledge);
  EXPECT_FALSE(reply.accepted);
  EXPECT_THAT(reply.sentence, HasSubstr("resetting took longer than 2000 ms: it waits for the "
                                        "controller to leave its fault"));
  EXPECT_EQ(bench.state(), JobState::faulted);
}

}  // namespace
}  // namespace biotomy::tests
