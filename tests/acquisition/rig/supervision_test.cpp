#include "acquisition/rig/supervision.hpp"

#include <map>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::Optional;

struct Rig {
  Supervision supervision{SafetyLimits{}};
  bridge::StageStatus status;
  bridge::SafetyInputs inputs{.estop_pressed = false, .door_open = false};
  TimePoint now{};
  bool answers = true;
  bool beats = true;

  Rig() {
    status.state = bridge::ControllerState::idle;
    status.interlocks = {false, false, false, true};
    status.block_temperature_c = -30.0;
  }

  std::optional<std::string> after(milliseconds time) {
    for (milliseconds passed{0}; passed < time; passed += milliseconds(20)) {
      now += milliseconds(20);
      if (beats) ++status.controller_heartbeat;
      supervision.observe(answers ? std::optional(status) : std::nullopt, inputs, now);
    }
    const auto cause = supervision.cause();
    return cause ? std::optional(cause->sentence) : std::nullopt;
  }
};

TEST(Supervision, IsContentWithAGoodRig) {
  Rig rig;
  EXPECT_EQ(rig.after(milliseconds(60000)), std::nullopt);
}

TEST(Supervision, SeesEveryInterlockOnBothWays) {
  Rig rig;
  rig.inputs.estop_pressed = true;
  EXPECT_THAT(rig.after(milliseconds(20)), Optional(HasSubstr("e-stop is pressed (line)")));
  rig.inputs = {false, true};
  EXPECT_THAT(rig.after(milliseconds(20)), Optional(HasSubstr("door is open (line)")));
  rig.inputs = {false, false};
  rig.status.interlocks.estop_pressed = true;
  EXPECT_THAT(rig.after(milliseconds(20)), Optional(HasSubstr("e-stop is pressed (controller)")));
}

TEST(Supervision, WaitsAMomentForAnAnswerAndNoLonger) {
  Rig rig;
  EXPECT_EQ(rig.after(milliseconds(100)), std::nullopt);
  rig.answers = false;
  EXPECT_EQ(rig.after(milliseconds(1400)), std::nullopt);
  EXPECT_THAT(rig.after(milliseconds(200)), Optional(HasSubstr("does not answer")));
}

TEST(Supervision, MissesAHeartbeatThatStandsStill) {
  Rig rig;
  EXPECT_EQ(rig.after(milliseconds(100)), std::nullopt);
  rig.beats = false;
  EXPECT_EQ(rig.after(milliseconds(900)), std::nullopt);
  EXPECT_THAT(rig.after(milliseconds(200)), Optional(HasSubstr("heartbeat stands still")));
}

TEST(Supervision, ForgivesAShortExcursionOfTheTemperatureOnly) {
  Rig rig;
  rig.status.block_temperature_c = 3.0;
  rig.after(milliseconds(4000));
  EXPECT_FALSE(rig.supervision.temperature_cause());
  rig.status.block_temperature_c = -30.0;
  rig.after(milliseconds(4000));
  EXPECT_FALSE(rig.supervision.temperature_cause());
  rig.status.block_temperature_c = 3.0;
  rig.after(milliseconds(6000));
  ASSERT_TRUE(rig.supervision.temperature_cause());
  EXPECT_THAT(rig.supervision.temperature_cause()->sentence, HasSubstr("the block is at 3.0 °C"));
  EXPECT_EQ(rig.supervision.temperature_cause()->kind, AlarmKind::temperature);
}

TEST(Supervision, ForgivesAShortPeakOfTheSpindlesLoadOnly) {
  Rig rig;
  rig.status.spindle_load_percent = 120.0;
  EXPECT_EQ(rig.after(milliseconds(900)), std::nullopt);
  rig.status.spindle_load_percent = 20.0;
  EXPECT_EQ(rig.after(milliseconds(900)), std::nullopt);
  rig.status.spindle_load_percent = 120.0;
  EXPECT_THAT(rig.after(milliseconds(1100)), Optional(HasSubstr("load is 120.0 %")));
}

TEST(Supervision, NamesTheControllersFault) {
  Rig rig;
  rig.status.state = bridge::ControllerState::faulted;
  rig.status.fault_code = 6;
  EXPECT_THAT(rig.after(milliseconds(20)), Optional(HasSubstr("spindle overload")));
  EXPECT_EQ(rig.supervision.cause()->kind, AlarmKind::wheel);
  EXPECT_FALSE(rig.supervision.standing_cause());  // resetting can cure it
}

TEST(Supervision, SeesABlockThatIsTooColdToo) {
  Rig rig;
  rig.status.block_temperature_c = -95.0;
  rig.after(milliseconds(6000));
  ASSERT_TRUE(rig.supervision.temperature_cause());
  EXPECT_THAT(rig.supervision.temperature_cause()->sentence, HasSubstr("the block is at -95.0 °C"));
}

TEST(Supervision, TakesLinesThatCannotBeReadForACauseOfTheirOwn) {
  Rig rig;
  rig.inputs = {.estop_pressed = false, .door_open = false, .failure = "no such chip"};
  EXPECT_THAT(rig.after(milliseconds(20)),
              Optional(HasSubstr("e-stop and door cannot be read: no such chip")));
  EXPECT_EQ(rig.supervision.cause()->kind, AlarmKind::lines);
  EXPECT_EQ(rig.supervision.standing_cause()->kind, AlarmKind::lines);
  EXPECT_EQ(Supervision::line_cause(rig.inputs)->kind, AlarmKind::lines);
}

TEST(Supervision, ForgivesAShortShakeOfTheSpindleOnly) {
  Rig rig;
  rig.status.vibration_mm_s = 20.0;
  EXPECT_EQ(rig.after(milliseconds(900)), std::nullopt);
  rig.status.vibration_mm_s = 2.0;
  EXPECT_EQ(rig.after(milliseconds(900)), std::nullopt);
  rig.status.vibration_mm_s = 20.0;
  EXPECT_THAT(rig.after(milliseconds(1100)), Optional(HasSubstr("vibrates by 20.0 mm/s")));
}

TEST(Supervision, ForgivesAWheelThatTurnsForAMomentOnly) {
  Rig rig;
  rig.status.spindle_rpm = 200.0;
  rig.after(milliseconds(400));
  EXPECT_FALSE(rig.supervision.wheel_cause());
  rig.after(milliseconds(200));
  ASSERT_TRUE(rig.supervision.wheel_cause());
  EXPECT_EQ(rig.supervision.wheel_cause()->kind, AlarmKind::wheel);
}

TEST(Supervision, KeepsTheLatchClosedWithoutAControllerThatAnswers) {
  Rig rig;
  rig.after(milliseconds(100));
  EXPECT_FALSE(rig.supervision.standing_cause());
  rig.answers = false;
  rig.after(milliseconds(1600));
  ASSERT_TRUE(rig.supervision.standing_cause());
  EXPECT_EQ(rig.supervision.standing_cause()->kind, AlarmKind::link);
}

TEST(Supervision, KnowsWhatEveryFaultCodeIsAbout) {
  // By the fault codes of docs/register-map.md, and one that it does not have.
  const std::map<std::uint16_t, AlarmKind> kinds = {
      {0, AlarmKind::controller}, {1, AlarmKind::emergency_stop}, {2, AlarmKind::door},
      {3, AlarmKind::watchdog},   {4, AlarmKind::motion},         {5, AlarmKind::motion},
      {6, AlarmKind::wheel},      {7, AlarmKind::controller}};
  std::set<std::string> texts;
  for (const auto& [code, kind] : kinds) {
    Rig rig;
    rig.status.state = bridge::ControllerState::faulted;
    rig.status.fault_code = code;
    rig.after(milliseconds(20));
    ASSERT_TRUE(rig.supervision.cause()) << code;
    EXPECT_EQ(rig.supervision.cause()->kind, kind) << code;
    texts.insert(rig.supervision.cause()->sentence);
  }
  EXPECT_EQ(texts.size(), kinds.size()) << "each has words of its own";
}

}  // namespace
}  // namespace biotomy::acquisition
