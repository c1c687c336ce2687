#include "acquisition/service/metrics/run_metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct RunMetricsTest : testing::Test {
  RunMetrics metrics{milliseconds(20)};
  JobStatus status;
  TimePoint now{std::chrono::hours(1)};

  void tick(milliseconds after = milliseconds(20)) {
    now += after;
    metrics.observe(status, now, now + milliseconds(3));
  }
  std::string text() const { return exposition(metrics.families()); }
};

TEST_F(RunMetricsTest, TimesEachStepButNoRest) {
  status.state = JobState::storing;
  tick();
  tick(seconds(2));
  status.state = JobState::paused;
  tick(milliseconds(500));
  status.state = JobState::grinding;
  tick(seconds(100));
  EXPECT_THAT(text(), AllOf(HasSubstr("step_duration_seconds_sum{step=\"storing\"} 2.5\n"),
                            HasSubstr("step_duration_seconds_count{step=\"storing\"} 1\n"),
                            Not(HasSubstr("paused")), Not(HasSubstr("grinding"))));
}

TEST_F(RunMetricsTest, CountsAttemptsByVerdictAndReason) {
  const auto judged = [&](std::int64_t layer, int attempt, Verdict verdict, const char* slug) {
    status.last_attempt = JudgedAttempt{layer, attempt, verdict, slug, {}};
    tick();
    tick();
  };
  judged(1, 1, Verdict::rejected, "blurred");
  judged(1, 2, Verdict::rejected, "blurred");
  judged(1, 2, Verdict::accepted_with_flag, "blurred");
  judged(2, 1, Verdict::accepted, "good");
  EXPECT_THAT(
      text(),
      AllOf(HasSubstr("attempts_total{verdict=\"rejected\",reason=\"blurred\"} 2\n"),
            HasSubstr(std::string("attempts_total{verdict=\"") +
                      to_string(Verdict::accepted_with_flag) + "\",reason=\"blurred\"} 1\n"),
            HasSubstr("attempts_total{verdict=\"accepted\",reason=\"good\"} 1\n")));
}

TEST_F(RunMetricsTest, CountsAlarmsButNotTheLatchOfTheStart) {
  status.alarm = Alarm{"the daemon has just started", "20:00"};
  tick();
  EXPECT_THAT(text(), HasSubstr("biotomy_alarms_total 0\n"));
  status.alarm.reset();
  tick();
  status.alarm = Alarm{"the door is open", "21:00"};
  tick();
  tick();
  EXPECT_THAT(text(), HasSubstr("biotomy_alarms_total 1\n"));
}

TEST_F(RunMetricsTest, MeasuresHowLateATickIs) {
  tick();
  tick(milliseconds(20));
  tick(milliseconds(60));
  EXPECT_THAT(text(), AllOf(HasSubstr("tick_lateness_seconds_sum 0.04\n"),
                            HasSubstr("tick_lateness_seconds_count 2\n"),
                            HasSubstr("tick_duration_seconds_sum 0.009\n")));
}

}  // namespace
}  // namespace biotomy::tests
