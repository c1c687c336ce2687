// `biotomyd --check` and `--list-devices`, as an engineer uses them to bring up a rig.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kFailure = 1;
constexpr int kUsage = 2;

RigPlan small_plan() {
  RigPlan plan;
  plan.layers = 3;
  plan.width = 64;
  plan.height = 48;
  return plan;
}

Outcome check(const fs::path& configuration, const std::vector<std::string>& more = {}) {
  std::vector<std::string> command{BIOTOMY_DAEMON, "--check", configuration};
  command.insert(command.end(), more.begin(), more.end());
  return run(command, configuration.parent_path());
}

std::set<std::string> files_of(const fs::path& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    files.insert(fs::relative(entry.path(), folder));
  }
  return files;
}

/// What stands in the lines of one part, wrong or not.
std::string lines_of(const std::string& text, const std::string& part) {
  std::istringstream lines(text);
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    if (line.find(" " + part + " ") != std::string::npos) found += line + "\n";
  }
  return found;
}

TEST(RigCheck, FindsNothingWrongWithARigThatCouldStartAndLeavesItAsItWas) {
  const SimulatedRig rig(small_plan());
  const std::set<std::string> before = files_of(rig.folder());
  const Outcome outcome = check(rig.folder() / "rig.toml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output << outcome.errors;
  EXPECT_THAT(outcome.output, testing::EndsWith("a job could start\n"));
  for (const char* part :
       {"controller", "plan", "lines", "camera", "calibration", "sample", "disk", "clock"}) {
    EXPECT_THAT(lines_of(outcome.output, part), testing::Not(IsEmpty())) << part;
  }
  EXPECT_THAT(lines_of(outcome.output, "camera"), HasSubstr("the lamp on"));
  EXPECT_THAT(rig.witnessed("command_started"), IsEmpty());
  EXPECT_EQ(rig.witnessed("capture").size(), 1U);
  const auto outputs = rig.witnessed("output_changed");
  ASSERT_EQ(outputs.size(), 2U);
  EXPECT_EQ(outputs.back().at("on"), false);

  std::set<std::string> after = files_of(rig.folder());
  std::erase_if(after,
                [&](const std::string& file) {  // the run's own output, and the twin's memory
                  return before.contains(file) || file.starts_with("controller.json") ||
                         file.ends_with(".out") || file.ends_with(".err");
                });
  EXPECT_THAT(after, IsEmpty());
}

TEST(RigCheck, NamesEveryDeviceThatDoesNotAnswer) {
  SimulatedRig rig(small_plan());
  rig.kill_twin();
  const Outcome outcome = check(rig.folder() / "rig.toml");
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(lines_of(outcome.output, "controller"),
              AllOf(HasSubstr("WRONG"), HasSubstr("is the controller on and the cable in?")));
  EXPECT_THAT(lines_of(outcome.output, "lines"),
              AllOf(HasSubstr("WRONG"), HasSubstr("e-stop and door cannot be read")));
  EXPECT_THAT(lines_of(outcome.output, "camera"), HasSubstr("WRONG"));
  EXPECT_THAT(lines_of(outcome.output, "clock"), HasSubstr("good"));
  EXPECT_THAT(outcome.output, HasSubstr("a job would not start: 3 things are wrong\n"));
}

TEST(RigCheck, LeavesTheDevicesToADaemonAtWork) {
  SimulatedRig rig(small_plan());
  rig.start_daemon();
  const Outcome outcome = check(rig.folder() / "rig.toml");
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(lines_of(outcome.output, "daemon"), HasSubstr("a biotomyd works on this sample"));
  EXPECT_THAT(rig.witnessed("capture"), IsEmpty());
  EXPECT_EQ(rig.end_daemon().exit_code, 0);
}

TEST(RigCheck, SaysThatASampleIsDone) {
  SimulatedRig rig(small_plan());
  rig.start_daemon();
  ASSERT_EQ(rig.rig("start").exit_code, 0);
  ASSERT_EQ(rig.rig("watch").exit_code, 0);
  ASSERT_EQ(rig.end_daemon().exit_code, 0);
  const std::set<std::string> before = files_of(rig.sample());
  const Outcome outcome = check(rig.folder() / "rig.toml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(lines_of(outcome.output, "sample"),
              AllOf(HasSubstr("3 of 3 layers are committed"), HasSubstr("nothing left to do")));
  EXPECT_EQ(files_of(rig.sample()), before);
}

TEST(RigCheck, GivesJsonToPrograms) {
  const SimulatedRig rig(small_plan());
  const Outcome outcome = check(rig.folder() / "rig.toml", {"--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const nlohmann::json document = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(document.at("can_start"), true);
  EXPECT_EQ(document.at("findings")[0].at("part"), "controller");
}

TEST(RigCheck, EndsWithTwoForAWrongConfiguration) {
  const TemporaryFolder folder;
  std::ofstream(folder / "rig.toml") << "[job]\nlayer = 3\n";
  const Outcome outcome = check(folder / "rig.toml");
  EXPECT_EQ(outcome.exit_code, kUsage);
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
}

TEST(RigCheck, OfTheSimulatedExampleFindsNothingWrong) {
  const TemporaryFolder folder;
  fs::copy_file(BIOTOMY_REGISTER_MAP, folder / "register_map.toml");
  // At any free port, beside whatever else this computer runs.
  const auto copy = [&](const char* name, const std::string& address) {
    std::ifstream file(fs::path(BIOTOMY_PACKAGING) / "examples" / name);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::string written_down = "tcp://127.0.0.1:1502";
    const std::size_t at = text.find(written_down);
    ASSERT_NE(at, std::string::npos) << name;
    text.replace(at, written_down.size(), address);
    const std::string page = "127.0.0.1:8080";
    if (const std::size_t found = text.find(page); found != std::string::npos) {
      text.replace(found, page.size(), "127.0.0.1:0");
    }
    std::ofstream(folder / name) << text;
  };
  copy("sim.toml", "tcp://127.0.0.1:0");
  fs::create_directory(folder / "said");
  ChildProcess twin({BIOTOMY_TWIN, "--config", folder / "sim.toml"}, folder / "said");
  const std::string ready = twin.wait_for("ready, stage on ", seconds(20));
  copy("simulated-rig.toml", ready.substr(0, ready.find(',')));
  const Outcome outcome = check(folder / "simulated-rig.toml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output << outcome.errors;
}

TEST(DeviceList, IsPrintedOnAnyComputer) {
  const TemporaryFolder folder;
  const Outcome text = run({BIOTOMY_DAEMON, "--list-devices"}, folder.path());
  EXPECT_EQ(text.exit_code, 0) << text.errors;
  for (const char* heading : {"cameras, by libcamera v", "GPIO chips\n", "serial ports\n"}) {
    EXPECT_THAT(text.output, HasSubstr(heading));
  }
  const Outcome json = run({BIOTOMY_DAEMON, "--list-devices", "--json"}, folder.path());
  EXPECT_EQ(json.exit_code, 0) << json.errors;
  EXPECT_TRUE(nlohmann::json::parse(json.output).at("serial_ports").is_array());
}

}  // namespace
}  // namespace biotomy::tests
