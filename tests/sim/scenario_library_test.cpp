// The scenarios in sim/scenarios, each played on a rig by a patient operator.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sim/scenario/scenario.hpp"
#include "sim/service/rig.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::sim {
namespace {

using namespace std::chrono_literals;

const std::filesystem::path kFolder = BIOTOMY_ROOT "/sim/scenarios";

std::vector<std::filesystem::path> library() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

Scenario load(const std::filesystem::path& file) {
  return read_scenario(bridge::CheckedTable::read_file(file));
}

/// Grinds and photographs on and on, and resets whatever fault comes.
class Operator {
 public:
  Operator(const Scenario& scenario, const std::filesystem::path& witness)
      : log_(witness, [] { return std::chrono::system_clock::time_point(); }),
        rig_({.seed = 1, .time_scale = 100, .scenario = scenario}, StateFile({}), log_, now_) {
    pass(1s);
  }

  void run(int layers) {
    for (int layer = 1; layer <= layers; ++layer) {
      for (int attempt = 0; attempt < kMostAttempts && ground() < layer; ++attempt) {
        if (rig_.read().status.state == ControllerState::faulted) give(Action::reset_fault, 0);
        if (!rig_.read().status.homed) give(Action::home, 0);
        give(Action::grind_pass, 20.0 * layer);
      }
      give(Action::retract, 0);
      give(Action::clear_face, 0);
      for (int photograph = 0; photograph < 4; ++photograph) {
        rig_.begin_capture();
        pass(10ms);
        rig_.end_capture();
      }
    }
    pass(20s);
  }

  /// Layers so far.
  int ground() { return static_cast<int>(rig_.read().memory.grind_count); }

 private:
  static constexpr int kMostAttempts = 100;  // of a layer

  void pass(std::chrono::milliseconds time) {
    for (std::chrono::milliseconds t{0}; t < time; t += 10ms) rig_.advance(now_ += 10ms);
  }

  /// Gives a command and waits, for a minute of the rig at most, until it ends.
  void give(Action action, double position_um) {
    rig_.submit({++sequence_, static_cast<std::uint16_t>(action), position_um, 600, 3000});
    pass(10ms);
    for (int i = 0; i < 60 && rig_.read().memory.sequence_finished != sequence_; ++i) pass(10ms);
  }

  Rig::RealTime now_{};
  WitnessLog log_;
  Rig rig_;
  std::uint32_t sequence_ = 0;
};

class ScenarioLibrary : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ScenarioLibrary, BreaksWhatItSaysAndMendsItInTime) {
  const tests::TemporaryFolder folder;
  const Scenario scenario = load(GetParam());
  constexpr int kLayers = 60;
  Operator person(scenario, folder / "witness.jsonl");
  person.run(kLayers);
  EXPECT_EQ(person.ground(), kLayers);
  std::multiset<std::string> began;
  std::multiset<std::string> ended;
  std::ifstream log(folder / "witness.jsonl");
  for (std::string line; std::getline(log, line);) {
    const nlohmann::json entry = nlohmann::json::parse(line);
    if (entry.at("event") == "fault_began") began.insert(entry.at("name").get<std::string>());
    if (entry.at("event") == "fault_ended") ended.insert(entry.at("name").get<std::string>());
  }
  for (const ScenarioEvent& event : scenario.events) {
    EXPECT_GT(began.count(event.name), 0U) << event.name;
    const bool for_good = !event.lasts.rig_seconds && !event.lasts.real_seconds &&
                          !event.lasts.captures && !event.lasts.grinds && !event.lasts.until_reset;
    if (for_good) {
      EXPECT_EQ(ended.count(event.name), 0U) << event.name;
    } else if (!event.lasts.until_reset) {  // who is told of no fault gives no reset
      EXPECT_EQ(ended.count(event.name), began.count(event.name)) << event.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, ScenarioLibrary, testing::ValuesIn(library()),
                         [](const auto& file) { return file.param.stem().string(); });

TEST(ScenarioFolder, BreaksEverythingOnceAndExplainsIt) {
  std::ifstream file(kFolder / "README.md");
  std::ostringstream readme;
  readme << file.rdbuf();
  std::set<std::string> broken;
  for (const std::filesystem::path& scenario : library()) {
    for (const ScenarioEvent& event : load(scenario).events) broken.insert(name_of(event.fault));
    EXPECT_NE(readme.str().find("`" + scenario.filename().string() + "`"), std::string::npos)
        << scenario;
  }
  EXPECT_EQ(broken.size(), std::variant_size_v<RigFault>);
}

}  // namespace
}  // namespace biotomy::sim
