#include <chrono>
#include <ostream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/faults/killed_run.hpp"
#include "tests/integration/witness_lines.hpp"

namespace biotomy::tests {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A moment of a run as the witness tells it: in the layer's cycle, which begins with its grind
/// pass, the nth line with this event and these facts.
struct WitnessedMoment {
  const char* name;
  int layer;  ///< 0: before the first
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

bool has_come(const SimulatedRig& rig, const WitnessedMoment& moment) {
  int layer = 0;
  int seen = 0;
  for (const std::string& text : witness_lines(rig.witness())) {
    const nlohmann::json line = nlohmann::json::parse(text);
    if (line.at("event") == "command_started" && line.at("action") == "grind_pass") ++layer;
    if (layer == moment.layer && line.at("event") == moment.event && holds(line, moment.facts)) {
      ++seen;
    }
  }
  return seen >= moment.nth;
}

void await(const SimulatedRig& rig, const WitnessedMoment& moment) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!has_come(rig, moment)) {
    if (std::chrono::steady_clock::now() > deadline) FAIL() << "it never came to this";
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
  if (HasFatalFailure()) return;
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
  const nlohmann::json any = nlohmann::json::object();
  return {
      {"AsItBeginsToHome", 0, "command_started", command("home")},
      {"WhileItHomes", 0, "command_started", command("home"), 1, milliseconds(3)},
      {"WhileTheFocusIsSearched", 1, "command_started", command("move_column"), 5},
      {"AsItBeginsToGrind", 2, "command_started", command("grind_pass")},
      {"WhileTheWheelRunsUp", 2, "command_started", command("grind_pass"), 1, milliseconds(8)},
      {"WhileItGrinds", 2, "command_started", command("grind_pass"), 1, milliseconds(25)},
      {"AsItHasGround", 2, "command_finished", command("grind_pass")},
      {"AsItBeginsToRetract", 2, "command_started", command("retract")},
      {"WhileItRetracts", 2, "command_started", command("retract"), 1, milliseconds(8)},
      {"WhileItClears", 2, "command_started", command("clear_face"), 1, milliseconds(3)},
      {"AsTheLampIsOn", 2, "output_changed", lamp(true)},
      {"AsTheColumnIsInFocus", 2, "command_finished", command("move_column")},
      {"AsItHasTakenAFrame", 2, "capture", any},
      {"WhileALayerIsStored", 2, "output_changed", lamp(false)},
      {"WhileItParksAtTheEnd", 4, "command_started", command("retract"), 2, milliseconds(3)},
  };
}

std::string name_of(const testing::TestParamInfo<WitnessedMoment>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Moments, KilledTwin, testing::ValuesIn(moments()), name_of);

}  // namespace
}  // namespace biotomy::tests
