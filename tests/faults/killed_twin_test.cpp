#include <chrono>
#include <ostream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/faults/killed_run.hpp"

namespace biotomy::tests {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A moment of a run as the witness tells it: the nth line with this event and these facts.
struct WitnessedMoment {
  const char* name;
  const char* event;
  nlohmann::json facts;
  int nth = 1;
  std::chrono::milliseconds later{0};  ///< the kill comes so long after it
};

void PrintTo(const WitnessedMoment& moment, std::ostream* out) {
  *out << moment.name;
}

bool holds(const nlohmann::json& line, const nlohmann::json& facts) {
  for (const auto& [key, value] : facts.items()) {
    if (line.at(key) != value) return false;
  }
  return true;
}

void await(const SimulatedRig& rig, const WitnessedMoment& moment) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  for (;;) {
    int seen = 0;
    for (const nlohmann::json& line : rig.witnessed(moment.event)) {
      if (holds(line, moment.facts)) ++seen;
    }
    if (seen >= moment.nth) break;
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "it never came to this";
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::this_thread::sleep_for(moment.later);
}

class KilledTwin : public testing::TestWithParam<WitnessedMoment> {};

TEST_P(KilledTwin, LeavesARunThatGoesOnToItsEnd) {
  const RigPlan plan{.width = 80, .height = 64, .layers = 4};
  UndisturbedRun undisturbed(plan);
  KilledRun run(plan);
  run.go_on();
  await(run.rig(), GetParam());
  run.rig().kill_twin();
  run.note_kill();
  run.rig().start_twin();
  run.finish();
  EXPECT_THAT(run.verdict(undisturbed.sample()), IsEmpty());
  EXPECT_THAT(run.alarms(), Each(Not(HasSubstr("disagrees"))));
}

std::vector<WitnessedMoment> moments() {
  using std::chrono::milliseconds;
  const auto command = [](const char* action) { return nlohmann::json{{"action", action}}; };
  const auto lamp = [](bool on) { return nlohmann::json{{"output", "lamp"}, {"on", on}}; };
  return {
      {"AsItBeginsToHome", "command_started", command("home")},
      {"WhileItHomes", "command_started", command("home"), 1, milliseconds(3)},
      {"AsItBeginsToGrind", "command_started", command("grind_pass"), 2},
      {"WhileTheWheelRunsUp", "command_started", command("grind_pass"), 2, milliseconds(8)},
      {"WhileItGrinds", "command_started", command("grind_pass"), 2, milliseconds(25)},
      {"AsItHasGround", "command_finished", command("grind_pass"), 2},
      {"AsItBeginsToRetract", "command_started", command("retract"), 2},
      {"WhileItRetracts", "command_started", command("retract"), 2, milliseconds(8)},
      {"WhileItClears", "command_started", command("clear_face"), 2, milliseconds(3)},
      {"AsTheLampIsOn", "output_changed", lamp(true), 2},
      {"WhileTheFocusIsSearched", "command_started", command("move_column"), 5},
      {"AsTheColumnIsInFocus", "command_finished", command("move_column"), 22},
      {"AsItHasTakenAFrame", "capture", nlohmann::json::object(), 14},
      {"WhileALayerIsStored", "output_changed", lamp(false), 2},
      {"WhileItParksAtTheEnd", "command_started", command("retract"), 5, milliseconds(3)},
  };
}

std::string name_of(const testing::TestParamInfo<WitnessedMoment>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Moments, KilledTwin, testing::ValuesIn(moments()), name_of);

}  // namespace
}  // namespace biotomy::tests
