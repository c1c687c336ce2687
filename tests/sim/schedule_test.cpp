#include "sim/scenario/schedule.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "sim/scenario/rig_condition.hpp"

namespace biotomy::sim {
namespace {

using namespace std::chrono_literals;
using Moment = Occasion::Moment;

/// A schedule of one event, in a clock of its own, with a record of what it told.
struct Play {
  explicit Play(const Occasion& when, const Duration& lasts = {}, std::uint64_t seed = 1)
      : schedule({.about = "", .events = {{"lamp", LampDead{}, when, lasts}}}, seed, events()) {
    run(0);
  }
  ScheduleEvents events() {
    return {.began = [this](const ScenarioEvent&) { ++began; },
            .ended = [this](const ScenarioEvent&) { ++ended; }};
  }
  void run(double seconds) { schedule.advance(rig_s += seconds, now); }
  void grind(std::uint32_t layer, bool done = true) {
    schedule.grind_started(layer);
    schedule.grind_ended(layer, done);
  }
  void capture() {
    schedule.capture_begins();
    schedule.capture_ends();
  }
  bool broken() const { return !schedule.active().empty(); }

  double rig_s = 0;
  Schedule::RealTime now{};
  int began = 0;
  int ended = 0;
  Schedule schedule;
};

TEST(Schedule, BreaksAtATimeForATime) {
  Play play({.at = 5}, {.rig_seconds = 2});
  play.run(4.9);
  EXPECT_FALSE(play.broken());
  play.run(0.2);
  EXPECT_TRUE(play.broken());
  play.run(1.9);
  EXPECT_TRUE(play.broken());
  play.run(0.2);
  EXPECT_FALSE(play.broken());
  play.run(100);
  EXPECT_EQ(play.began, 1);
  EXPECT_EQ(play.ended, 1);
}

TEST(Schedule, BreaksFromTheBeginningAndForGoodIfNothingElseIsSaid) {
  Play play({});
  EXPECT_TRUE(play.broken());
  play.run(1e6);
  play.schedule.reset_given();
  EXPECT_TRUE(play.broken());
  EXPECT_EQ(play.began, 1);
}

TEST(Schedule, CountsRealSecondsByTheOtherClock) {
  Play play({}, {.real_seconds = 2});
  play.run(1000);
  EXPECT_TRUE(play.broken());
  play.now += 2s;
  play.run(0);
  EXPECT_FALSE(play.broken());
}

TEST(Schedule, BreaksAtALayerAfterADelay) {
  Play play({.moment = Moment::grind_started, .at = 3, .delay_s = 1});
  play.grind(1);
  play.grind(2);
  play.grind(3);
  EXPECT_FALSE(play.broken());
  play.run(1);
  EXPECT_TRUE(play.broken());
}

TEST(Schedule, TakesALayerForFinishedOnlyIfItsPassWasNotBrokenOff) {
  Play play({.moment = Moment::grind_finished, .at = 3});
  play.grind(3, false);
  EXPECT_FALSE(play.broken());
  play.grind(3);
  EXPECT_TRUE(play.broken());
}

TEST(Schedule, RepeatsEveryFewLayersAndNeverForOnesThatAreOver) {
  Play play({.moment = Moment::grind_started, .at = 2, .every = 3}, {.grinds = 1});
  play.grind(9);  // the twin began in the middle of a block: 2, 5 and 8 are over
  EXPECT_EQ(play.began, 0);
  for (std::uint32_t layer = 10; layer <= 14; ++layer) play.grind(layer);
  EXPECT_EQ(play.began, 2);  // 11 and 14
  EXPECT_EQ(play.ended, 2);
}

TEST(Schedule, BreaksALayerOnceHoweverOftenItIsTried) {
  Play play({.moment = Moment::grind_started, .at = 2, .every = 1}, {.grinds = 1});
  play.grind(2, false);
  play.grind(2, false);
  EXPECT_EQ(play.began, 1);
}

TEST(Schedule, BreaksForSoManyPhotographs) {
  Play play({.moment = Moment::capture, .at = 2}, {.captures = 2});
  play.capture();
  EXPECT_EQ(play.began, 0);
  play.schedule.capture_begins();
  EXPECT_TRUE(play.broken());
  play.schedule.capture_ends();
  EXPECT_TRUE(play.broken());
  play.schedule.camera_failed();
  EXPECT_FALSE(play.broken());
}

TEST(Schedule, EndsWithTheResetThatItWaitsFor) {
  Play play({}, {.until_reset = true});
  play.schedule.reset_given();
  EXPECT_FALSE(play.broken());
  EXPECT_EQ(play.ended, 1);
}

TEST(Schedule, DrawsTheSameLotsForTheSameSeed) {
  const auto lots = [](std::uint64_t seed) {
    std::string drawn;
    Play play({.moment = Moment::grind_started, .at = 1, .every = 1, .probability = 0.3},
              {.grinds = 1}, seed);
    for (std::uint32_t layer = 1; layer <= 1000; ++layer) {
      const int before = play.began;
      play.grind(layer);
      drawn += play.began > before ? '1' : '0';
    }
    return drawn;
  };
  const std::string first = lots(1);
  EXPECT_EQ(lots(1), first);
  EXPECT_NE(lots(2), first);
  EXPECT_NEAR(static_cast<double>(std::ranges::count(first, '1')), 300, 60);
}

TEST(Schedule, TakesUpAndEndsEventsOfTheBench) {
  Play play({.at = 1e6});
  play.schedule.add({.name = "door", .fault = DoorOpen{}, .when = {}, .lasts = {}});
  EXPECT_TRUE(play.broken());
  play.schedule.add({.name = "door", .fault = EstopPressed{}, .when = {}, .lasts = {}});
  EXPECT_EQ(play.schedule.active().size(), 1U);
  EXPECT_TRUE(play.schedule.remove("door"));
  EXPECT_FALSE(play.broken());
  EXPECT_FALSE(play.schedule.remove("door"));
  EXPECT_TRUE(play.schedule.remove("lamp"));
  play.run(2e6);
  EXPECT_FALSE(play.broken());
}

TEST(RigCondition, IsSoundWithoutAFault) {
  const RigCondition condition = condition_of({}, 7);
  EXPECT_TRUE(condition.controller_powered);
  EXPECT_TRUE(condition.camera.answers());
  EXPECT_FALSE(condition.camera.spoils_frames());
  EXPECT_EQ(condition.lamp_share, 1);
  EXPECT_FALSE(condition.estop_pressed || condition.door_open);
}

TEST(RigCondition, AddsUpTheFaultsThatLast) {
  const RigCondition condition = condition_of({{LampDims{0.5}, 0},
                                               {LampDims{0.5}, 0},
                                               {AxisCreeps{MachineAxis::column, 3}, 0},
                                               {AxisReadsWrong{MachineAxis::column, -2}, 0},
                                               {GrindRemovesTooLittle{4}, 0}},
                                              1);
  EXPECT_EQ(condition.lamp_share, 0.25);
  EXPECT_EQ(condition.machine.column.creep_um_s, 3);
  EXPECT_EQ(condition.machine.column.read_error_um, -2);
  EXPECT_EQ(condition.machine.feed.creep_um_s, 0);
  EXPECT_EQ(condition.machine.wheel_short_um, 4);
}

TEST(RigCondition, AddsUpWhatTheCameraSees) {
  const RigCondition condition = condition_of({{LampLightsUnevenly{0.1, -0.2}, 0},
                                               {LampLightsUnevenly{0.1, 0}, 0},
                                               {LampChangesColour{0.5, 1, 1}, 0},
                                               {LampChangesColour{0.5, 1, 0.9}, 0},
                                               {FaceFrosts{0.2, 0.6}, 0},
                                               {FaceGlares{0.01}, 0},
                                               {BlockShifts{30, 40}, 0},
                                               {BlockShifts{30, 0}, 0}},
                                              1);
  EXPECT_EQ(condition.lamp_field, (LampField{0.2, -0.2, {0.25, 1, 0.9}}));
  EXPECT_EQ(condition.film.frost.share, 0.2);
  EXPECT_EQ(condition.film.frost.opacity, 0.6);
  EXPECT_EQ(condition.film.glare.share, 0.01);
  EXPECT_EQ(condition.displacement, (Displacement{60, 40}));
  EXPECT_TRUE(condition_of({}, 1).lamp_field.is_even());
}

TEST(RigCondition, LetsTheDoorBounceAndTheLampFlicker) {
  const std::vector<ActiveFault> faults{{DoorBounces{1.0, 0.1}, 10}, {LampFlickers{0.4, 0.5}, 10}};
  EXPECT_TRUE(condition_of(faults, 10.05).door_open);
  EXPECT_FALSE(condition_of(faults, 10.5).door_open);
  EXPECT_TRUE(condition_of(faults, 11.05).door_open);
  EXPECT_NEAR(condition_of(faults, 10).lamp_share, 1, 1e-9);
  EXPECT_NEAR(condition_of(faults, 11).lamp_share, 0.4, 1e-9);
}

}  // namespace
}  // namespace biotomy::sim
