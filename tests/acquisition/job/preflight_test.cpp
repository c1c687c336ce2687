#include "acquisition/job/preflight.hpp"

#include <filesystem>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/job/job.hpp"
#include "tests/acquisition/held_job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;

/// Starts the job and expects it to be stopped before anything moved.
void expect_refusal(JobBench& bench, const std::string& cause) {
  bench.start_daemon();
  bench.say(OperatorCommand::start);
  ASSERT_TRUE(bench.reach(JobState::faulted, 500)) << cause;
  EXPECT_THAT(bench.alarm(), HasSubstr(cause));
  for (const auto& entry : bench.stage.executed) {
    EXPECT_THAT(entry.command.action,
                testing::AnyOf(bridge::StageAction::stop, bridge::StageAction::retract));
  }
}

TEST(Preflight, RefusesAControllerThatDoesNotWatchTheDaemon) {
  JobBench bench;
  bench.stage.identity.watchdog_timeout = std::chrono::milliseconds(0);
  expect_refusal(bench, "does not watch the daemon's heartbeat");
}

TEST(Preflight, RefusesAWatchdogThatBarksTooLateOrTooSoon) {
  for (const int watchdog_ms : {100, 5001, 60000}) {
    JobBench bench;
    bench.stage.identity.watchdog_timeout = std::chrono::milliseconds(watchdog_ms);
    expect_refusal(bench, "heartbeat for " + std::to_string(watchdog_ms) +
                              " ms (watchdog_timeout), and should for 250 ms to 5000 ms");
  }
}

TEST(Preflight, TakesAnyWatchdogWhenNoneIsRequired) {
  JobBench bench;
  bench.settings.limits.require_watchdog = false;
  bench.stage.identity.watchdog_timeout = std::chrono::milliseconds(60000);
  bench.start_daemon();
  bench.say(OperatorCommand::start);
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
}

TEST(Preflight, RefusesAToleranceOfAWholeLayer) {
  JobBench bench;
  bench.settings.plan.layer_thickness = {5.0};
  expect_refusal(bench,
                 "safety.position_tolerance_um is 5 and must be at most half of "
                 "job.layer_thickness_um, which is 5");
}

TEST(Preflight, RefusesALastLayerBeyondTheFeed) {
  JobBench bench;
  bench.stage.identity.feed.maximum = {1079.0};
  expect_refusal(bench, "layer 5 would be at 1080 µm of the feed");
}

TEST(Preflight, RefusesALastFocusBeyondTheColumn) {
  JobBench bench;
  bench.stage.identity.column.maximum = {650.0};
  expect_refusal(bench, "the focus of the last layer would be at 670 µm of the column");
}

TEST(Preflight, RefusesToFocusWithALensThatIsNotThere) {
  JobBench bench;
  bench.settings.focus.actuator = FocusSettings::Actuator::lens;
  expect_refusal(bench, "focus.actuator is \"lens\" and the camera \"fake\" has none");
}

TEST(Preflight, RefusesALastFocusBeyondTheLens) {
  JobBench bench;
  bench.settings.focus.actuator = FocusSettings::Actuator::lens;
  bench.camera.lens = bridge::LensRange{.farthest = 1600.0, .nearest = 10000.0};
  expect_refusal(bench, "the focus of the last layer would be at 670 µm of the lens");
}

TEST(Preflight, RefusesADiskWithoutRoomForTheWholeJob) {
  JobBench bench;
  bench.settings.plan.layers = 1000;
  bench.stage.identity.column.maximum = {30000.0};
  // Room for the reserve of 20 layers and some more, of 2 × 96 × 64 × 3 bytes each.
  bench.free_bytes = std::uintmax_t{30} * 2 * 96 * 64 * 3;
  expect_refusal(bench, "the disk has room for 30 more layers and the job needs 1000");
  bench.settings.limits.disk_for_whole_job = false;
  bench.start_daemon();
  bench.start_job();
  EXPECT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
}

TEST(Preflight, RefusesAComputerWhoseClockIsNotSet) {
  JobBench bench;
  bench.settings.limits.preflight_limit = std::chrono::seconds(2);
  bench.wall_clock_start = std::chrono::system_clock::time_point{};
  expect_refusal(bench, "the computer's clock says 1970-01-01");
}

TEST(Preflight, WaitsUntilTheClockIsSet) {
  JobBench bench;
  const auto right = std::exchange(bench.wall_clock_start, {});
  bench.start_job();
  bench.tick(2900);  // 58 s of the minute that a preflight may take
  EXPECT_EQ(bench.state(), JobState::preflight) << bench.alarm();
  EXPECT_THAT(bench.board.look()->waiting_for,
              HasSubstr("waits for the computer's clock to be set: it says 1970-01-01"));
  EXPECT_FALSE(std::filesystem::exists(bench.settings.plan.sample));
  bench.wall_clock_start = right;
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
}

/// A job that was paused, and a daemon that starts by a clock that is behind what the journal says.
struct BehindTheJournal : JobBench {
  std::chrono::system_clock::time_point right = wall_clock_start;
  std::size_t ground = 0;  ///< passes until then

  BehindTheJournal() {
    settings.limits.preflight_limit = std::chrono::seconds(2);
    start_daemon();
    start_job();
    reach_committed(1);
    say(OperatorCommand::pause);
    reach(JobState::paused);
    ground = stage.ground().size();
    wall_clock_start -= std::chrono::days(30);
    start_daemon();
  }
};

TEST(Preflight, WaitsForAClockThatIsBehindTheJournal) {
  BehindTheJournal bench;
  bench.start_job();
  bench.tick(90);
  EXPECT_EQ(bench.state(), JobState::preflight) << bench.alarm();
  EXPECT_THAT(bench.board.look()->waiting_for,
              HasSubstr("and the journal's last record is of 2026-11-01"));
  bench.wall_clock_start = bench.right;
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
}

TEST(Preflight, GoesOnByAClockThatWasBehindTheJournalWhenThatIsAcknowledged) {
  BehindTheJournal bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_EQ(bench.board.look()->alarm->kind, AlarmKind::preflight);
  EXPECT_THAT(bench.alarm(), HasSubstr("the journal's last record is of 2026-11-01"));
  EXPECT_THAT(bench.alarm(), HasSubstr("if it is right, the record is wrong: acknowledge"));
  EXPECT_EQ(bench.stage.ground().size(), bench.ground);

  bench.tick(20);
  ASSERT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
  ASSERT_TRUE(bench.say(OperatorCommand::resume).accepted);
  ASSERT_TRUE(bench.reach_committed(2)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("events", "text LIKE 'the clock is right, as was acknowledged%'"), 1);
  bench.start_daemon();
  bench.start_job();
  EXPECT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("events", "text LIKE 'the clock is right, as was acknowledged%'"), 1);
}

TEST(Preflight, TakesAnAbortForNoWordOnTheClock) {
  BehindTheJournal bench;
  bench.start_job();
  bench.tick(20);
  ASSERT_TRUE(bench.say(OperatorCommand::abort).accepted);
  ASSERT_TRUE(bench.reach(JobState::aborted)) << bench.alarm();
  ASSERT_TRUE(bench.say(OperatorCommand::start).accepted);
  EXPECT_TRUE(bench.reach(JobState::faulted));
  EXPECT_EQ(bench.stage.ground().size(), bench.ground);
}

TEST(Preflight, GivesTheRestOfTheChecksTheirTimeAfterTheClock) {
  HeldJobBench bench;
  bench.settings.limits.preflight_limit = std::chrono::seconds(2);
  const auto right = std::exchange(bench.wall_clock_start, {});
  bench.start_daemon();
  bench.start_job();
  bench.tick(90);
  bench.wall_clock_start = right;
  bench.tick(90);
  EXPECT_EQ(bench.state(), JobState::preflight) << bench.alarm();
  EXPECT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
}

TEST(Preflight, WritesDownThatItTookATrialFrame) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  EXPECT_THAT(bench.events_of_kind("recovery"), HasSubstr("trial frame 1\n"));
}

TEST(Preflight, RefusesACameraOfOtherBits) {
  JobBench bench;
  bench.settings.plan.bits = 16;
  expect_refusal(bench, "the camera gives 8 bits of each colour and job.bits is 16");
}

TEST(Preflight, RefusesACameraThatGivesNoFrame) {
  JobBench bench;
  bench.camera.gone = true;
  expect_refusal(bench, "camera: gone");
}

TEST(Preflight, RefusesACameraSetOtherwiseThanForTheLayersBefore) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::storing));
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.say(OperatorCommand::pause);
  ASSERT_TRUE(bench.reach(JobState::paused));
  const auto grinds = bench.stage.ground().size();

  bench.settings.camera.settings.red_gain = 1.25;
  bench.start_daemon();
  bench.say(OperatorCommand::start);
  ASSERT_TRUE(bench.reach(JobState::faulted, 500));
  EXPECT_THAT(bench.alarm(), HasSubstr("were photographed with camera.red_gain = 1, and the next "
                                       "would be with 1.25: restore it"));
  EXPECT_EQ(bench.stage.ground().size(), grinds);

  bench.settings.camera.settings.red_gain = 1.0;
  bench.start_daemon();
  bench.start_job();
  EXPECT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
}

TEST(Preflight, TakesOtherSettingsOfTheCameraBeforeTheFirstLayer) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::grinding));
  bench.say(OperatorCommand::abort);
  ASSERT_TRUE(bench.reach(JobState::aborted));
  bench.settings.camera.settings.blue_gain = 1.5;
  bench.start_daemon();
  bench.start_job();
  EXPECT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
}

TEST(Preflight, RefusesACameraThatExposesAsItLikes) {
  JobBench bench;
  bench.settings.camera.settings.exposure = std::chrono::microseconds(15000);
  expect_refusal(bench, "the camera took a frame with an exposure in us of 10000 instead of 15000");
  bench.settings.camera.settings.exposure = std::chrono::microseconds(10000);
  bench.settings.camera.settings.gain = 2.0;
  expect_refusal(bench, "the camera took a frame with a gain of 1 instead of 2");
}

}  // namespace
}  // namespace biotomy::tests
