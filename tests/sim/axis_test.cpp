#include "sim/physics/axis.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace biotomy::sim {
namespace {

struct Ride {
  Axis axis;
  double highest_um = -1e9;

  explicit Ride(const AxisSettings& settings) : axis(settings) {}
  void run(double seconds) {
    for (double t = 0; t < seconds; t += 0.001) {
      axis.advance(0.001);
      highest_um = std::max(highest_um, axis.position_um());
    }
  }
  void go(double target_um) {
    axis.go_to(target_um, 1000);
    run(10);
  }
};

TEST(Axis, ArrivesExactlyAndAtOnceIfItIsIdeal) {
  Ride ride({});
  ride.axis.go_to(100, 1000);
  EXPECT_FALSE(ride.axis.arrived());
  ride.run(0.0995);
  EXPECT_TRUE(ride.axis.arrived());
  EXPECT_EQ(ride.axis.position_um(), 100);
  EXPECT_EQ(ride.axis.mechanical_um(), 100);
  ride.axis.go_to(100, 1000);
  EXPECT_TRUE(ride.axis.arrived());
}

TEST(Axis, SwingsBeyondItsTargetAndHasArrivedOnceItStandsStill) {
  Ride ride({.overshoot_um = 4, .settling_s = 0.2});
  ride.axis.go_to(100, 1000);
  ride.run(0.15);
  EXPECT_FALSE(ride.axis.arrived());
  EXPECT_NEAR(ride.highest_um, 104, 0.1);
  ride.run(0.2);
  EXPECT_TRUE(ride.axis.arrived());
  EXPECT_EQ(ride.axis.position_um(), 100);
}

TEST(Axis, LagsByItsBacklashOnTheWayDownOnly) {
  Ride ride({.backlash_um = 3});
  ride.go(100);
  EXPECT_EQ(ride.axis.mechanical_um(), 100);
  ride.go(99);
  EXPECT_EQ(ride.axis.position_um(), 99);
  EXPECT_EQ(ride.axis.mechanical_um(), 100);
  ride.go(50);
  EXPECT_EQ(ride.axis.mechanical_um(), 53);
  ride.go(52);
  EXPECT_EQ(ride.axis.mechanical_um(), 53);
  ride.go(60);
  EXPECT_EQ(ride.axis.mechanical_um(), 60);
}

TEST(Axis, StandsWhereItIsHalted) {
  Ride ride({.backlash_um = 2, .overshoot_um = 4, .settling_s = 0.2});
  ride.axis.go_to(100, 1000);
  ride.run(0.05);
  ride.axis.halt();
  const double where_um = ride.axis.position_um();
  ride.run(1);
  EXPECT_TRUE(ride.axis.arrived());
  EXPECT_EQ(ride.axis.position_um(), where_um);
}

TEST(Axis, GoesNowhereWhileItsMotorIsStalledAndOnAfterwards) {
  Ride ride({});
  ride.axis.set_defects({.stalled = true});
  ride.go(100);
  EXPECT_FALSE(ride.axis.arrived());
  EXPECT_EQ(ride.axis.position_um(), 0);
  ride.axis.set_defects({});
  ride.run(1);
  EXPECT_EQ(ride.axis.position_um(), 100);
}

TEST(Axis, GivesWayWhileItCreeps) {
  Ride ride({});
  ride.go(100);
  ride.axis.set_defects({.creep_um_s = -5});
  ride.run(2);
  EXPECT_NEAR(ride.axis.position_um(), 90, 0.1);
  EXPECT_NEAR(ride.axis.mechanical_um(), 90, 0.1);
  EXPECT_TRUE(ride.axis.arrived());
  EXPECT_EQ(ride.axis.target_um(), 100);
}

TEST(Axis, ShowsAnotherPositionThanTheTrueOneWithAScaleThatIsWrong) {
  Ride ride({});
  ride.axis.set_defects({.read_error_um = 7});
  ride.go(100);
  EXPECT_EQ(ride.axis.position_um(), 107);
  EXPECT_EQ(ride.axis.mechanical_um(), 100);
}

}  // namespace
}  // namespace biotomy::sim
