// A job that waits for its block to be cold, or for room on the disk.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/job/job.hpp"
#include "tests/acquisition/job_bench.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using bridge::StageAction;
using testing::HasSubstr;

constexpr double kWarm = -2.0;
constexpr double kCold = -30.0;
constexpr std::uintmax_t kNoRoom = 10;
constexpr std::uintmax_t kRoom = std::uintmax_t{1} << 40U;

TEST(JobConditioning, GrindsNothingBeforeTheBlockIsCold) {
  JobBench bench;
  bench.stage.status.block_temperature_c = kWarm;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::conditioning)) << bench.alarm();
  bench.tick(1000);
  EXPECT_EQ(bench.state(), JobState::conditioning);
  EXPECT_THAT(bench.board.look()->waiting_for, HasSubstr("the block, at -2.0 °C"));
  EXPECT_TRUE(bench.stage.ground().empty());
  bench.stage.status.block_temperature_c = kCold;
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
}

TEST(JobConditioning, CallsAPersonWhenTheCoolingDoesNotCool) {
  JobBench bench;
  bench.settings.limits.conditioning_progress_time = std::chrono::seconds(10);
  bench.start_daemon();
  bench.stage.status.block_temperature_c = kWarm;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_THAT(bench.alarm(), HasSubstr("look at the cooling"));
}

TEST(JobConditioning, CanBePausedAndResumed) {
  JobBench bench;
  bench.stage.status.block_temperature_c = kWarm;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::conditioning));
  EXPECT_TRUE(bench.say(OperatorCommand::pause).accepted);
  ASSERT_TRUE(bench.reach(JobState::paused));
  EXPECT_EQ(bench.board.look()->pause_cause, "");
  EXPECT_TRUE(bench.say(OperatorCommand::resume).accepted);
  EXPECT_TRUE(bench.reach(JobState::conditioning)) << bench.alarm();
}

TEST(JobHold, OfAWarmBlockIsAnAlarmUnlessConfiguredOtherwise) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach(JobState::focusing));
  bench.stage.status.block_temperature_c = kWarm;
  bench.stage.exchanges_per_command = 1000;
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_THAT(bench.alarm(), HasSubstr("the block is at -2.0 °C"));
  bench.stage.exchanges_per_command = 2;
  bench.tick(200);
  EXPECT_THAT(bench.say(OperatorCommand::acknowledge).sentence,
              HasSubstr("still there: the block"));
  bench.stage.status.block_temperature_c = kCold;
  EXPECT_TRUE(bench.say(OperatorCommand::acknowledge).accepted);
}

struct HeldForTemperature : testing::Test {
  HeldForTemperature() {
    bench.settings.limits.temperature_resumes = true;
    bench.start_daemon();
    bench.start_job();
  }
  /// A pass of the wheel that would take two minutes, and a block that gets warm in it.
  void warm_up_while_grinding() {
    ASSERT_TRUE(bench.reach(JobState::grinding));
    bench.stage.exchanges_per_command = 6000;
    bench.tick(10);
    bench.stage.status.block_temperature_c = kWarm;
    ASSERT_TRUE(bench.reach(JobState::withdrawing)) << bench.alarm();
    bench.stage.exchanges_per_command = 2;
    ASSERT_TRUE(bench.reach(JobState::held)) << bench.alarm();
  }
  JobBench bench;
};

TEST_F(HeldForTemperature, StopsTheWheelParksAndGoesOnByItself) {
  warm_up_while_grinding();
  EXPECT_GE(bench.stage.count(StageAction::stop), 1);
  EXPECT_EQ(bench.stage.status.traverse.value, 0.0);
  EXPECT_TRUE(bench.lines.on.contains(bridge::OutputRole::tower_light));
  const auto executed = bench.stage.executed.size();
  bench.tick(1000);
  EXPECT_EQ(bench.stage.executed.size(), executed) << "it moved while it was held";
  bench.stage.status.block_temperature_c = kCold;
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("layers"), 5);
  EXPECT_EQ(bench.count_rows("grinds", "result = 'done'"), 5);
  EXPECT_THAT(bench.events_of_kind("alarm"), HasSubstr("held: the block is at -2.0 °C"));
}

TEST_F(HeldForTemperature, IsFaultedByADoorThatIsOpened) {
  warm_up_while_grinding();
  bench.lines.inputs.door_open = true;
  ASSERT_TRUE(bench.reach(JobState::faulted)) << "hands could be inside";
  bench.lines.inputs.door_open = false;
  bench.stage.status.block_temperature_c = kCold;
  const auto executed = bench.stage.executed.size();
  bench.tick(2000);
  EXPECT_EQ(bench.state(), JobState::faulted);
  EXPECT_EQ(bench.stage.count(StageAction::grind_pass), 1);
  EXPECT_LE(bench.stage.executed.size(), executed + 2);  // stop and retract
}

TEST_F(HeldForTemperature, BecomesAPauseWhenAnOperatorAsks) {
  warm_up_while_grinding();
  EXPECT_TRUE(bench.say(OperatorCommand::pause).accepted);
  ASSERT_TRUE(bench.reach(JobState::paused));
  bench.stage.status.block_temperature_c = kCold;
  bench.tick(2000);
  EXPECT_EQ(bench.state(), JobState::paused);
}

TEST_F(HeldForTemperature, CallsAPersonWhenItStaysWarm) {
  bench.settings.limits.conditioning_progress_time = std::chrono::seconds(30);
  bench.job.reset();
  bench.start_daemon();
  bench.start_job();
  warm_up_while_grinding();
  ASSERT_TRUE(bench.reach(JobState::faulted));
  EXPECT_THAT(bench.alarm(), HasSubstr("look at the cooling"));
}

TEST(JobHold, OfAFullDiskGoesOnByItselfWhenThereIsRoom) {
  JobBench bench;
  bench.settings.limits.disk_resumes = true;
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  bench.free_bytes = kNoRoom;
  ASSERT_TRUE(bench.reach(JobState::held)) << bench.alarm();
  EXPECT_EQ(bench.count_rows("layers"), 2);  // the layer in work is safe
  EXPECT_EQ(bench.stage.ground().size(), 2U);
  bench.tick(1000);
  EXPECT_EQ(bench.state(), JobState::held);
  EXPECT_THAT(bench.board.look()->waiting_for, HasSubstr("room for 0 layers and needs 40"));
  bench.free_bytes = kRoom;
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.stage.ground().size(), 5U);
}

TEST(JobHold, OfAFullDiskWaitsForAsMuchRoomAsThePreflightAsksFor) {
  JobBench bench;
  bench.settings.limits.disk_resumes = true;
  bench.settings.plan.layers = 60;
  bench.start_daemon();
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  bench.free_bytes = kNoRoom;
  ASSERT_TRUE(bench.reach(JobState::held)) << bench.alarm();
  bench.free_bytes = std::uintmax_t{45} * 2 * 96 * 64 * 3;  // 45 layers, and 58 are to come
  bench.tick(1000);
  EXPECT_EQ(bench.state(), JobState::held) << bench.alarm();
  EXPECT_THAT(bench.board.look()->waiting_for, HasSubstr("room for 45 layers and needs 58"));
  bench.free_bytes = kRoom;
  EXPECT_TRUE(bench.reach(JobState::grinding)) << bench.alarm();
}

TEST(JobPause, TellsWhyWhenNobodyAskedForIt) {
  JobBench bench;
  bench.start_job();
  ASSERT_TRUE(bench.reach_committed(1)) << bench.alarm();
  bench.camera.black_frames = 1000000;
  ASSERT_TRUE(bench.reach(JobState::paused));
  EXPECT_THAT(bench.board.look()->pause_cause, HasSubstr("no frame of layer 2 was good enough"));
  EXPECT_THAT(bench.board.look()->waiting_for, HasSubstr("no frame of layer 2"));
  bench.camera.black_frames = 0;
  bench.say(OperatorCommand::resume);
  ASSERT_TRUE(bench.reach(JobState::done)) << bench.alarm();
  EXPECT_EQ(bench.board.look()->pause_cause, "");
}

}  // namespace
}  // namespace biotomy::tests
