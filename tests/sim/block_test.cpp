#include "sim/physics/block.hpp"

#include <gtest/gtest.h>

#include "sim/physics/mechanics.hpp"

namespace biotomy::sim {
namespace {

Block smooth_block() {
  return {1, 900, 0.0, DebrisSettings{}};
}

TEST(Block, IsCutToTheDepthOfThePassAndNeverGrows) {
  Block block = smooth_block();
  block.begin_pass(1000);
  block.cut_to(1.0);
  EXPECT_EQ(block.shallowest_um(), 1000);
  block.begin_pass(950);
  block.cut_to(1.0);
  EXPECT_EQ(block.mean_um(), 1000);
}

TEST(Block, KeepsAStepWhenAPassIsBrokenOff) {
  Block block = smooth_block();
  block.begin_pass(1000);
  block.cut_to(0.5);
  EXPECT_EQ(block.strip_depth_um().front(), 1000);
  EXPECT_EQ(block.strip_depth_um().back(), 900);
  EXPECT_EQ(block.mean_um(), 950);
}

TEST(Block, MissesTheTargetByItsRoughnessAlone) {
  Block block(1, 0, 0.5, DebrisSettings{});
  bool missed = false;
  for (int i = 1; i <= 50; ++i) {
    block.begin_pass(10.0 * i);
    block.cut_to(1.0);
    EXPECT_NEAR(block.mean_um(), 10.0 * i, 3 * 0.5);
    missed = missed || block.mean_um() != 10.0 * i;
  }
  EXPECT_TRUE(missed);
}

TEST(Block, CarriesDebrisUntilItIsBlownAway) {
  Block block = smooth_block();
  EXPECT_TRUE(block.debris().empty());
  block.begin_pass(1000);
  block.cut_to(1.0);
  EXPECT_EQ(block.debris().size(), 40U);
  block.blow(300);
  EXPECT_LT(block.debris().size(), 30U);
  EXPECT_GT(block.debris().size(), 5U);
  block.blow(300);
  EXPECT_TRUE(block.debris().empty());
}

struct Machine {
  MechanicsSettings settings;
  Mechanics mechanics{settings, smooth_block()};

  void run(double seconds) {
    for (double t = 0; t < seconds; t += 0.004) mechanics.advance(0.004);
  }
  void sweep(double feed_um, double rpm) {
    mechanics.turn_spindle(rpm);
    run(2);
    mechanics.feed.go_to(feed_um, 2000);
    mechanics.traverse.go_to(mechanics.face_begin_um() - 100, 60000);
    run(4);
    mechanics.traverse.go_to(mechanics.face_end_um() + 100, 6000);
  }
};

TEST(Mechanics, GrindsWhatTheWheelPassesOver) {
  Machine machine;
  machine.sweep(1010, 3000);
  machine.run(1.0);
  EXPECT_TRUE(machine.mechanics.cutting());
  EXPECT_GT(machine.mechanics.spindle_load_percent(), 20);
  EXPECT_EQ(machine.mechanics.block().strip_depth_um().front(), 1010);
  EXPECT_EQ(machine.mechanics.block().strip_depth_um().back(), 900);
  machine.run(2.0);
  EXPECT_FALSE(machine.mechanics.cutting());
  EXPECT_EQ(machine.mechanics.block().shallowest_um(), 1010);
}

TEST(Mechanics, GrindsNothingWithTheWheelStandingOrTooHigh) {
  Machine standing;
  standing.sweep(1010, 0);
  standing.run(3);
  EXPECT_EQ(standing.mechanics.block().deepest_um(), 900);
  Machine high;
  high.sweep(880, 3000);
  high.run(3);
  EXPECT_EQ(high.mechanics.block().deepest_um(), 900);
  EXPECT_EQ(high.mechanics.block().state().passes, 0U);
}

TEST(Mechanics, LoadsTheSpindleByDepthSpeedAndWear) {
  const auto load = [](double depth_um, double speed_um_s, const MechanicsSettings& settings) {
    Machine machine{settings};
    machine.sweep(900 + depth_um, 3000);
    machine.mechanics.traverse.go_to(machine.mechanics.face_end_um(), speed_um_s);
    while (!machine.mechanics.cutting()) machine.run(0.004);
    machine.run(0.3);
    return machine.mechanics.spindle_load_percent();
  };
  const double plain = load(100, 6000, {});
  EXPECT_GT(load(200, 6000, {}), 1.5 * plain);
  EXPECT_GT(load(100, 9000, {}), 1.3 * plain);
  EXPECT_GT(load(100, 6000, {.wheel_wear_um_mm3 = 1, .load_per_wear_um = 1}), 1.3 * plain);
}

TEST(Mechanics, LeavesTheFaceHigherTheMoreTheWheelHasWorn) {
  Machine machine{{.wheel_wear_um_mm3 = 0.1}};
  const auto pass = [&](double feed_um) {
    machine.mechanics.traverse.go_to(0, 60000);
    machine.run(4);
    machine.sweep(feed_um, 3000);
    machine.run(4);
  };
  pass(1000);  // 100 µm of 10 mm × 10 mm: 10 mm³
  EXPECT_NEAR(machine.mechanics.wheel_worn_um(), 1.0, 1e-6);
  EXPECT_EQ(machine.mechanics.block().mean_um(), 1000);
  pass(1020);
  EXPECT_NEAR(machine.mechanics.block().mean_um(), 1019, 1e-6);
}

TEST(Mechanics, GrindsWhereTheWheelIsNotWhereTheScaleSays) {
  Machine machine{{.feed = {.speed_um_s = 2000, .backlash_um = 5}}};
  machine.mechanics.feed.go_to(1020, 2000);
  machine.run(2);
  machine.sweep(1018, 3000);  // from below: the wheel stays where it was
  machine.run(3);
  EXPECT_EQ(machine.mechanics.feed.position_um(), 1018);
  EXPECT_EQ(machine.mechanics.block().mean_um(), 1020);
}

TEST(Mechanics, ShakesForAWhileAfterTheSpindleStopped) {
  Machine machine{{.vibration_decay_s = 0.5}};
  machine.mechanics.turn_spindle(3000);
  machine.run(2);
  const double turning = machine.mechanics.vibration_mm_s();
  EXPECT_NEAR(turning, 0.15, 0.01);
  machine.mechanics.turn_spindle(0);
  machine.run(1.1);
  EXPECT_EQ(machine.mechanics.spindle_rpm(), 0);
  EXPECT_GT(machine.mechanics.vibration_mm_s(), 0.1 * turning);
  machine.run(5);
  EXPECT_LT(machine.mechanics.vibration_mm_s(), 0.01 * turning);
}

TEST(Mechanics, TakesTimeToMove) {
  Machine machine;
  machine.mechanics.column.go_to(4000, 4000);
  machine.run(0.5);
  EXPECT_NEAR(machine.mechanics.column.position_um(), 2000, 20);
  machine.run(0.6);
  EXPECT_EQ(machine.mechanics.column.position_um(), 4000);
}

}  // namespace
}  // namespace biotomy::sim
