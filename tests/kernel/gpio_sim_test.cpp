// The GPIO lines against a real kernel: chips of gpio-sim, whose wires this program pulls. Needs
// root, gpio-sim and configfs. Where they are missing the tests are skipped and say so; with
// BIOTOMY_KERNEL_TESTS=1 in the environment they fail.
#include <cstdlib>
#include <optional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "firmware_bridge/device_error.hpp"
#include "firmware_bridge/lines/gpiod_lines.hpp"
#include "tests/firmware_bridge/thrown_message.hpp"
#include "tests/kernel/gpio_other_process.hpp"
#include "tests/kernel/gpio_sim_chip.hpp"

namespace biotomy::tests {
namespace {

using namespace std::chrono_literals;
using bridge::DeviceError;
using bridge::GpiodLines;
using bridge::GpiodLinesSettings;
using bridge::LineBias;
using bridge::OutputRole;
using bridge::SafetyInputs;
using bridge::testing::thrown_message;
using ::testing::AllOf;
using ::testing::HasSubstr;

enum Wire : unsigned int { estop, door, lamp, trigger, tower_light };

bool is_asked_for() {
  const char* wanted = std::getenv("BIOTOMY_KERNEL_TESTS");
  return wanted && std::string(wanted) == "1";
}

/// A rig wired as it should be: e-stop and door closed to ground while all is well, with pull-ups.
class GpioSim : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = GpioSimChip::missing(); !why.empty()) {
      if (is_asked_for()) FAIL() << why;
      GTEST_SKIP() << why;
    }
    chip_.emplace("biotomy-test-" + std::to_string(::getpid()),
                  std::vector<std::string>{"ESTOP", "DOOR", "LAMP", "TRIGGER", ""});
    settings_.estop = {.chip = chip_->label(), .line = "ESTOP"};
    settings_.door = {.chip = chip_->label(), .line = "DOOR"};
    settings_.lamp = {.chip = chip_->label(), .line = "LAMP"};
    settings_.trigger = {.chip = chip_->label(), .line = "TRIGGER", .active_low = true};
    settings_.debounce = 20ms;
  }

  /// With a clock that `look` moves on.
  std::unique_ptr<GpiodLines> make() {
    return std::make_unique<GpiodLines>(settings_, bridge::make_gpio_chips(),
                                        [this] { return now_; });
  }
  std::unique_ptr<GpiodLines> make_with_the_real_clock() {
    return std::make_unique<GpiodLines>(settings_);
  }

  /// The next tick's look.
  SafetyInputs look(GpiodLines& lines) {
    now_ += 20ms;
    return lines.read_inputs();
  }

  /// Looks until one shows what is expected. The kernel notes an edge a little after the wire
  /// moved, so the first look may come too early; ten seconds without it are a failure.
  template <class Expected>
  bool comes(GpiodLines& lines, Expected expected) {
    const auto end = std::chrono::steady_clock::now() + 10s;
    while (std::chrono::steady_clock::now() < end) {
      if (expected(look(lines))) return true;
      std::this_thread::sleep_for(1ms);
    }
    return false;
  }

  bool becomes_safe(GpiodLines& lines) {
    return comes(lines, [](const SafetyInputs& inputs) {
      return !inputs.estop_pressed && !inputs.door_open && inputs.failure.empty();
    });
  }
  bool shows_estop(GpiodLines& lines) {
    return comes(lines, [](const SafetyInputs& inputs) { return inputs.estop_pressed; });
  }

  /// `edges` of them, the last one to `high`. As fast as can be: gpio-sim may hand interrupts out
  /// only at the kernel's next timer tick, and what comes within one is a single edge then.
  void rattle(Wire wire, int edges, bool high) {
    for (int left = edges; left > 0; --left) chip_->pull(wire, (left % 2 == 1) == high);
  }

  std::string refusal() {
    return thrown_message<DeviceError>([this] { make(); });
  }

  std::string consumer_of(Wire wire) {
    return bridge::make_gpio_chips()->describe(chip_->device()).lines.at(wire).consumer;
  }

  std::optional<GpioSimChip> chip_;
  GpiodLinesSettings settings_;
  std::chrono::steady_clock::time_point now_{1h};
};

TEST_F(GpioSim, LevelsArriveAndEachInputIsItsOwn) {
  const auto lines = make();
  EXPECT_TRUE(becomes_safe(*lines));
  chip_->pull(door, true);
  SafetyInputs inputs = look(*lines);
  EXPECT_FALSE(inputs.estop_pressed);
  EXPECT_TRUE(inputs.door_open);
  chip_->pull(door, false);
  EXPECT_TRUE(becomes_safe(*lines));
}

TEST_F(GpioSim, ALowLevelIsActiveWhereTheLineIsActiveLow) {
  settings_.estop.active_low = true;
  chip_->pull(estop, true);
  const auto lines = make();
  EXPECT_TRUE(becomes_safe(*lines));
  chip_->pull(estop, false);
  EXPECT_TRUE(look(*lines).estop_pressed);
  chip_->pull(estop, true);
  EXPECT_TRUE(becomes_safe(*lines));
}

TEST_F(GpioSim, TheBiasPullsALineThatNobodyDrives) {
  settings_.estop.bias = LineBias::pull_up;
  settings_.door.bias = LineBias::pull_down;
  chip_->pull(door, true);
  const auto lines = make();
  EXPECT_TRUE(chip_->is_high(estop));
  EXPECT_FALSE(chip_->is_high(door));
  const SafetyInputs inputs = look(*lines);
  EXPECT_TRUE(inputs.estop_pressed);
  EXPECT_FALSE(inputs.door_open);
}

TEST_F(GpioSim, AChipIsFoundByPathNameAndLabelAndALineByOffset) {
  for (const std::string& chip : {chip_->device().string(), chip_->name(), chip_->label()}) {
    settings_.tower_light = {.chip = chip, .line = std::to_string(tower_light)};
    const auto lines = make();
    lines->set(OutputRole::tower_light, true);
    EXPECT_TRUE(chip_->is_high(tower_light)) << chip;
  }
}

TEST_F(GpioSim, WhatIsNotThereIsNamedWithWhatIs) {
  settings_.estop.chip = "no-such-chip";
  EXPECT_THAT(refusal(), AllOf(HasSubstr("lines.estop: line ESTOP of GPIO chip no-such-chip"),
                               HasSubstr(chip_->label()), HasSubstr("5 lines")));
  settings_.estop = {.chip = chip_->label(), .line = "ESTPO"};
  EXPECT_THAT(refusal(), HasSubstr("did you mean \"ESTOP\"?"));
  settings_.estop = {.chip = "/dev/null", .line = "ESTOP"};
  EXPECT_THAT(refusal(), HasSubstr("/dev/null cannot be opened as a GPIO chip"));
}

TEST_F(GpioSim, AChipThatMayNotBeOpenedNamesTheGroup) {
  constexpr uid_t kNobody = 65534;
  ASSERT_EQ(::seteuid(kNobody), 0);
  const std::string message = refusal();
  ASSERT_EQ(::seteuid(0), 0);
  EXPECT_THAT(message, HasSubstr("group gpio"));
}

TEST_F(GpioSim, LinesAreHeldUnderTheDaemonsName) {
  {
    const auto lines = make();
    EXPECT_EQ(consumer_of(estop), "biotomyd");
    EXPECT_EQ(consumer_of(lamp), "biotomyd");
  }
  EXPECT_EQ(consumer_of(estop), "");
  EXPECT_EQ(consumer_of(lamp), "");
}

TEST_F(GpioSim, ALineThatIsHeldNamesWhoHoldsIt) {
  GpioOtherProcess other(GpioOtherProcess::holds(chip_->device(), door, "door-watch"));
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr("lines.door: line DOOR"), HasSubstr("is held by \"door-watch\"")));
  other.kill();
  EXPECT_TRUE(becomes_safe(*make()));
}

TEST_F(GpioSim, OneLineForTwoRolesIsRefused) {
  settings_.door.line = "ESTOP";
  EXPECT_THAT(refusal(), AllOf(HasSubstr("lines.door"), HasSubstr("another of the roles")));
}

TEST_F(GpioSim, APulseBetweenTwoLooksIsSeen) {
  const auto lines = make();
  ASSERT_TRUE(becomes_safe(*lines));
  rattle(estop, 2, false);
  EXPECT_TRUE(shows_estop(*lines));
  EXPECT_TRUE(becomes_safe(*lines));
}

TEST_F(GpioSim, APulseBetweenTwoLooksIsLostWithoutEdges) {
  settings_.estop.edges = false;
  const auto lines = make();
  ASSERT_TRUE(becomes_safe(*lines));
  rattle(estop, 2, false);
  for (int tick = 0; tick < 10; ++tick) EXPECT_FALSE(look(*lines).estop_pressed);
  chip_->pull(estop, true);
  EXPECT_TRUE(look(*lines).estop_pressed);
}

TEST_F(GpioSim, AnEstopThatBouncesIsPressedFromTheFirstEdgeOn) {
  const auto lines = make();
  ASSERT_TRUE(becomes_safe(*lines));
  chip_->pull(estop, true);
  ASSERT_TRUE(look(*lines).estop_pressed);
  for (int bounce = 0; bounce < 20; ++bounce) {
    rattle(estop, 6, true);
    ASSERT_TRUE(look(*lines).estop_pressed) << bounce;
  }
  for (int tick = 0; tick < 10; ++tick) EXPECT_TRUE(look(*lines).estop_pressed);
}

TEST_F(GpioSim, AnEstopThatBouncesOnReleaseIsSafeOnlyAfterwards) {
  settings_.debounce = 200ms;
  const auto lines = make_with_the_real_clock();
  chip_->pull(estop, true);
  ASSERT_TRUE(lines->read_inputs().estop_pressed);
  const auto end = std::chrono::steady_clock::now() + 3 * settings_.debounce;
  while (std::chrono::steady_clock::now() < end) {
    rattle(estop, 3, false);
    ASSERT_TRUE(lines->read_inputs().estop_pressed);
  }
  EXPECT_TRUE(becomes_safe(*lines));
}

TEST_F(GpioSim, AfterAStormOfEdgesTheLevelIsRight) {
  const auto lines = make();
  ASSERT_TRUE(becomes_safe(*lines));
  rattle(estop, 4000, false);
  EXPECT_TRUE(shows_estop(*lines));
  EXPECT_TRUE(becomes_safe(*lines));

  rattle(estop, 4001, true);
  for (int tick = 0; tick < 100; ++tick) ASSERT_TRUE(look(*lines).estop_pressed) << tick;
  chip_->pull(estop, false);
  EXPECT_TRUE(becomes_safe(*lines));
}

TEST_F(GpioSim, AfterTheKernelsQueueRanOverTheLevelIsRight) {
  const auto lines = make();
  ASSERT_TRUE(becomes_safe(*lines));
  // Slowly enough that each edge has an interrupt of its own. The queue keeps 16.
  for (const bool last : {false, true}) {
    for (int edge = 0; edge < 40; ++edge) {
      rattle(estop, 1, (edge % 2 == 1) == last);
      std::this_thread::sleep_for(15ms);
    }
    EXPECT_TRUE(look(*lines).estop_pressed);
    if (last) {
      for (int tick = 0; tick < 10; ++tick) EXPECT_TRUE(look(*lines).estop_pressed) << tick;
    } else {
      EXPECT_TRUE(becomes_safe(*lines));
    }
  }
}

TEST_F(GpioSim, AChipThatIsUnpluggedIsUnsafeAndIsTakenBackWhenItReturns) {
  const auto lines = make();
  ASSERT_TRUE(becomes_safe(*lines));
  chip_->unplug();
  SafetyInputs inputs = look(*lines);
  EXPECT_TRUE(inputs.estop_pressed);
  EXPECT_TRUE(inputs.door_open);
  EXPECT_THAT(inputs.failure, AllOf(HasSubstr("lines.estop: the line failed"),
                                    HasSubstr("lines.door: the line failed")));
  EXPECT_THAT(thrown_message<DeviceError>([&] { lines->set(OutputRole::lamp, false); }),
              HasSubstr("lines.lamp: the line failed"));
  now_ += 1s;
  inputs = look(*lines);
  EXPECT_TRUE(inputs.estop_pressed);
  EXPECT_THAT(inputs.failure, HasSubstr("there is no chip of that path, name or label"));

  chip_->plug_in();
  EXPECT_TRUE(look(*lines).estop_pressed);  // not asked again within the second
  EXPECT_TRUE(becomes_safe(*lines));
  EXPECT_EQ(consumer_of(estop), "biotomyd");
  rattle(estop, 2, false);
  EXPECT_TRUE(shows_estop(*lines));
  lines->set(OutputRole::lamp, true);
  EXPECT_TRUE(chip_->is_high(lamp));
}

TEST_F(GpioSim, OutputsAreOffFirstAndLast) {
  chip_->pull(lamp, true);
  auto lines = make();
  EXPECT_FALSE(chip_->is_high(lamp));
  EXPECT_TRUE(chip_->is_high(trigger));  // active low
  lines->set(OutputRole::lamp, true);
  lines->set(OutputRole::trigger, true);
  EXPECT_TRUE(chip_->is_high(lamp));
  EXPECT_FALSE(chip_->is_high(trigger));
  lines->set(OutputRole::lamp, false);
  EXPECT_FALSE(chip_->is_high(lamp));
  lines->set(OutputRole::lamp, true);
  // gpio-sim gives a line that nobody holds back to its pull. So this shows that the lines were
  // let go; that they were switched off before, the tests with fake chips show.
  chip_->pull(lamp, false);
  chip_->pull(trigger, true);
  lines.reset();
  EXPECT_FALSE(chip_->is_high(lamp));
  EXPECT_TRUE(chip_->is_high(trigger));
}

TEST_F(GpioSim, AfterAKillTheLinesAreFreeAndTheNextStartSwitchesOff) {
  GpioOtherProcess daemon([this](const std::function<void()>& ready) {
    const auto lines = make();
    lines->set(OutputRole::lamp, true);
    ready();
  });
  ASSERT_EQ(consumer_of(lamp), "biotomyd");
  ASSERT_TRUE(chip_->is_high(lamp));
  // gpio-sim gives the line back to its pull; so it stands for a chip that goes on driving.
  chip_->pull(lamp, true);
  daemon.kill();
  EXPECT_EQ(consumer_of(lamp), "");
  EXPECT_TRUE(chip_->is_high(lamp));
  const auto lines = make();
  EXPECT_FALSE(chip_->is_high(lamp));
  EXPECT_TRUE(becomes_safe(*lines));
}

}  // namespace
}  // namespace biotomy::tests
