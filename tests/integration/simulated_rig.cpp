#include "tests/integration/simulated_rig.hpp"

#include <csignal>
#include <fstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "firmware_bridge/wire/checked_table.hpp"
#include "sim/service/configuration.hpp"

namespace biotomy::tests {

namespace {

using std::chrono::seconds;

constexpr double kFirstFaceUm = 1000;
constexpr double kColumnOffsetUm = 350;
constexpr double kFocusGuessErrorUm = 25;  // the operator's guess is near, not right

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

}  // namespace

SimulatedRig::SimulatedRig(const RigPlan& plan) : plan_(plan) {
  const std::filesystem::path sim_config = folder() / "sim.toml";
  const std::string number = std::to_string(plan.time_scale);
  write_text(sim_config,
             "seed = 7\ntime_scale = " + number +
                 "\nstate_file = \"controller.json\"\nwitness_log = \"witness.jsonl\"\n"
                 "[stage]\nlisten = \"tcp://127.0.0.1:0\"\nregister_map = \"" BIOTOMY_REGISTER_MAP
                 "\"\n[rig]\nsocket = \"unix://rig.socket\"\n[camera]\nwidth = " +
                 std::to_string(plan.width) + "\nheight = " + std::to_string(plan.height) +
                 "\npixel = " + std::to_string(plan.pixel_um) +
                 "\ncolumn_offset = " + std::to_string(kColumnOffsetUm) +
                 "\n[block]\nfirst_face = " + std::to_string(kFirstFaceUm) + "\n");
  phantom_ = std::make_unique<sim::Phantom>(
      sim::read_configuration(bridge::CheckedTable::read_file(sim_config)).phantom);
  twin_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{BIOTOMY_TWIN, "--config", sim_config}, folder());
  const std::string ready = twin_->wait_for("ready, stage on ", seconds(20));
  const std::string stage = ready.substr(0, ready.find(','));

  write_text(folder() / "rig.toml",
             "[stage]\nendpoint = \"" + stage +
                 "\"\nregister_map = \"" BIOTOMY_REGISTER_MAP
                 "\"\n[lines]\nbackend = \"socket\"\nendpoint = \"unix://rig.socket\"\n"
                 "[camera]\nbackend = \"socket\"\nendpoint = \"unix://rig.socket\"\n"
                 "exposure_us = 10000\n"
                 "[job]\nsample = \"sample\"\nlayers = " +
                 std::to_string(plan.layers) + "\nlayer_thickness_um = " +
                 std::to_string(plan.layer_thickness_um) + "\npixel_um = [" +
                 std::to_string(plan.pixel_um) + ", " + std::to_string(plan.pixel_um) +
                 "]\nfirst_face_um = " + std::to_string(kFirstFaceUm) +
                 "\nclear_ms = 1500\nsettle_ms = 5\nlamp_warm_up_ms = 5\n"
                 "[focus]\nstart_um = " +
                 std::to_string(kFirstFaceUm - kColumnOffsetUm + kFocusGuessErrorUm) +
                 "\n[service]\nlisten = \"127.0.0.1:0\"\ntoken_file = \"token\"\ntick_ms = 2\n");
}

void SimulatedRig::start_daemon() {
  daemon_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{BIOTOMY_DAEMON, "--config", folder() / "rig.toml"}, folder());
  url_ = "http://" + daemon_->wait_for("listening on http://", seconds(20));
}

void SimulatedRig::kill_daemon() {
  daemon_->send(SIGKILL);
  daemon_->wait(seconds(10));
  daemon_.reset();
}

Outcome SimulatedRig::rig(const std::string& command, seconds limit) {
  return run({BIOTOMY_TOOL, "rig", command, "--url", url_, "--token-file", folder() / "token"},
             folder(), limit);
}

nlohmann::json SimulatedRig::status() {
  const Outcome outcome = run({BIOTOMY_TOOL, "rig", "status", "--json", "--url", url_}, folder());
  if (outcome.exit_code != 0) throw std::runtime_error(outcome.errors);
  return nlohmann::json::parse(outcome.output);
}

std::vector<nlohmann::json> SimulatedRig::witnessed(const std::string& event) const {
  std::vector<nlohmann::json> events;
  std::ifstream log(folder() / "witness.jsonl");
  for (std::string line; std::getline(log, line);) {
    nlohmann::json entry = nlohmann::json::parse(line);
    if (entry.at("event") == event) events.push_back(std::move(entry));
  }
  return events;
}

}  // namespace biotomy::tests
