#include "acquisition/job/focus_step.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/job/job.hpp"
#include "acquisition/rig/lens_actuator.hpp"
#include "acquisition/service/status_json.hpp"
#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::HasSubstr;

TEST(FocusStep, FocusesWithTheLensAndLeavesTheColumnAlone) {
  JobBench bench;
  bench.settings.focus.actuator = FocusSettings::Actuator::lens;
  bench.camera.lens = bridge::LensRange{.farthest = 1.0, .nearest = 10000.0};
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done, 5000)) << bench.alarm();
  EXPECT_EQ(bench.stage.count(bridge::StageAction::move_column), 0);
  ASSERT_FALSE(bench.camera.lens_positions.empty());
  // The last face is ground to 1080 µm, and sharp 400 µm before.
  EXPECT_NEAR(distance_of(bench.camera.lens_positions.back()).value, 680.0, 4.0);
}

TEST(FocusStep, TellsOfItsLastSearchInTheStatus) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done, 5000)) << bench.alarm();
  const auto status = bench.board.look();
  ASSERT_TRUE(status->focus);
  EXPECT_TRUE(status->focus->found);
  EXPECT_EQ(status->focus->layer, 1);
  EXPECT_EQ(bench.count_rows("focus_sweeps", "json_array_length(points) = " +
                                                 std::to_string(status->focus->frames)),
            1);
  EXPECT_NEAR(status->focus->plane.value, 600.0, 4.0);
  EXPECT_THAT(status_json(*status, {}), HasSubstr("\"actuator\":\"column\""));
}

/// Rows of layers whose frames have a focus_change for which `condition` holds.
std::string with_change(const std::string& condition) {
  return "EXISTS (SELECT 1 FROM json_each(metrics) AS metric WHERE "
         "metric.value ->> 'name' = 'focus_change' AND " +
         condition + ")";
}

TEST(FocusStep, TellsWithEachFrameHowFarTheFocusIsFromWhereItWasExpected) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "layer = 1 AND " + with_change("1")), 0)
      << "of the first layer nothing was expected";
  EXPECT_EQ(bench.count_rows("attempts", with_change("metric.value ->> 'value' = 0 AND "
                                                     "metric.value ->> 'limit' = 40 "
                                                     "AND metric.value ->> 'passed'")),
            4);
}

TEST(FocusStep, SaysThatASearchFoundTheFocusFarFromWhereItWasExpected) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(2)) << bench.alarm();
  bench.camera.column_to_face_um += 100.0;
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows(
                "attempts",
                "layer = 3 AND verdict = 'accepted' AND reason LIKE '%left its way by -%' AND " +
                    with_change("abs(metric.value ->> 'value' + 50) < 2 AND "
                                "metric.value ->> 'limit' = 40 AND "
                                "NOT metric.value ->> 'passed'")),
            1);
}

/// Two layers on, the ladder's first search finds a window instead of the face.
void find_a_window(JobBench& bench) {
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(2)) << bench.alarm();
  bench.camera.black_frames = 2;
  const auto third_attempt = [&] {
    return bench.board.look()->attempt == 2 && bench.state() == JobState::focusing;
  };
  for (int i = 0; i < 5000 && !third_attempt(); ++i) bench.tick();
  bench.camera.column_to_face_um = 200.0;
  bench.worker.at_edges = [&bench] {
    const bool found = bench.count_rows("focus_sweeps", "layer = 3 AND found = 1") > 0;
    if (found) bench.camera.column_to_face_um = 400.0;
  };
  for (int i = 0; i < 5000 && bench.camera.column_to_face_um < 400.0; ++i) bench.tick();
  ASSERT_EQ(bench.count_rows("focus_sweeps", "layer = 3 AND abs(column_um - 840) < 5"), 1);
}

/// Searches for layer 3 that looked on both sides of its face at first.
std::int64_t searches_around_the_face(const JobBench& bench) {
  return bench.count_rows("focus_sweeps",
                          "layer = 3 AND found = 1 AND abs(column_um - 640) < 5 AND "
                          "points ->> '$[0][0]' < 640 AND json_array_length(points) < 8");
}

TEST(FocusStep, ForgetsWhatASearchFoundWhoseFrameIsRejected) {
  JobBench bench;
  ASSERT_NO_FATAL_FAILURE(find_a_window(bench));
  ASSERT_TRUE(bench.reach_committed(3)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("attempts", "layer = 3 AND attempt = 3 AND slug = 'blurred'"), 1);
  EXPECT_EQ(searches_around_the_face(bench), 1);
}

TEST(FocusStep, ForgetsItAlsoOverAPauseAndARestart) {
  for (const bool restarts : {false, true}) {
    JobBench bench;
    bench.settings.ladder.max_attempts = 3;
    ASSERT_NO_FATAL_FAILURE(find_a_window(bench));
    ASSERT_TRUE(bench.reach(JobState::paused)) << bench.alarm();
    if (restarts) {
      bench.start_daemon();
      bench.start_job();
    } else {
      EXPECT_TRUE(bench.say(OperatorCommand::resume).accepted);
    }
    ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
    EXPECT_EQ(searches_around_the_face(bench), 1);
    EXPECT_EQ(bench.count_rows("attempts", "layer = 3"), 4) << "the first frame is sharp again";
  }
}

TEST(FocusStep, ComesToEveryFrameFromBelow) {
  JobBench bench;
  std::vector<double> column;
  bench.stage.on_command = [&](const bridge::StageCommand& command) {
    if (command.action == bridge::StageAction::move_column) {
      column.push_back(command.position.value);
    }
  };
  int seen = 0;
  bench.stage.on_exchange = [&] {
    if (bench.camera.captures == seen || column.size() < 2) return;
    seen = bench.camera.captures;
    EXPECT_GT(column.back(), column[column.size() - 2]) << "frame " << seen;
  };
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::done, 5000)) << bench.alarm();
  EXPECT_GT(seen, 10);
}

TEST(FocusStep, StopsAJobWhoseFirstSearchFindsNothing) {
  JobBench bench;
  bench.camera.column_to_face_um = -90000.0;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::faulted, 5000));
  EXPECT_THAT(bench.alarm(), HasSubstr("no focus was found around 590.0 µm of the column"));
  EXPECT_LE(bench.camera.captures, 1 + 9 * 6) << "a search is bounded";
}

/// How many frames the records of broken-off searches hold, with that reason.
std::int64_t frames_of_broken_searches(const JobBench& bench, const std::string& reason) {
  std::int64_t frames = 0;
  for (int points = 1; points < 60; ++points) {
    frames += points * bench.count_rows("focus_sweeps", "found = 0 AND why LIKE '%" + reason +
                                                            "%' AND json_array_length(points) = " +
                                                            std::to_string(points));
  }
  return frames;
}

TEST(FocusStep, RecordsTheFramesOfASearchThatIsBrokenOff) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::focusing)) << bench.alarm();
  const int before = bench.camera.captures;
  while (bench.camera.captures < before + 4) bench.tick();
  bench.stage.status.interlocks.door_open = true;  // the fourth frame is not yet looked at
  ASSERT_TRUE(bench.reach(JobState::faulted, 2));
  EXPECT_EQ(frames_of_broken_searches(bench, "broken off: the door is open"), 4);
}

TEST(FocusStep, RecordsTheFramesOfASearchWhoseCameraFails) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::focusing)) << bench.alarm();
  const int before = bench.camera.captures;
  while (bench.camera.captures < before + 3) bench.tick();
  bench.camera.gone = true;
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_EQ(frames_of_broken_searches(bench, "broken off: camera: gone"), 3);
}

TEST(FocusStep, GivesUpASearchThatTakesTooLong) {
  JobBench bench;
  bench.settings.focus.time_limit = std::chrono::milliseconds(1);
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::faulted, 5000));
  EXPECT_THAT(bench.alarm(), HasSubstr("the search took longer than focus.time_limit_ms, 1 ms"));
  EXPECT_LE(bench.camera.captures, 2) << "the camera's test, and one of the search";
}

TEST(LensActuator, TakesDioptresForTheReciprocalOfTheDistance) {
  EXPECT_NEAR(dioptres_at({100000.0}), 10.0, 1e-12);
  EXPECT_NEAR(distance_of(4.0).value, 250000.0, 1e-9);
  const bridge::AxisLimits limits = lens_limits({.farthest = 0.0, .nearest = 10.0});
  EXPECT_NEAR(limits.minimum.value, 1e5, 1e-6);
  EXPECT_NEAR(limits.maximum.value, 1e7, 1e-3) << "infinity is ten metres away";
}

}  // namespace
}  // namespace biotomy::tests
