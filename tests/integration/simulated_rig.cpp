#include "tests/integration/simulated_rig.hpp"

#include <csignal>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <nlohmann/json.hpp>

#include "firmware_bridge/wire/checked_table.hpp"
#include "sim/service/configuration.hpp"
#include "tests/integration/witness_lines.hpp"

namespace biotomy::tests {

namespace {

using std::chrono::seconds;

constexpr double kColumnOffsetUm = 350;
constexpr double kFocusGuessErrorUm = 25;  // the operator's guess is near, not right

/// By /proc/PID/fd (proc_pid_fd(5)).
int sockets_of(pid_t process) {
  int sockets = 0;
  const std::filesystem::path folder = "/proc/" + std::to_string(process) + "/fd";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::error_code closed_meanwhile;
    const std::string file = std::filesystem::read_symlink(entry, closed_meanwhile);
    if (file.starts_with("socket:")) ++sockets;
  }
  return sockets;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

/// Runs of very small frames are about something else than quality: in so few pixels and cells
/// chance is greater than any limit.
std::string quality_settings(const RigPlan& plan) {
  constexpr int kFewestPixels = 19200;
  if (plan.width * plan.height >= kFewestPixels) return "";
  return "[quality]\nminimum_sharpness_ratio = 0\nminimum_sharpness_along_axis = 0\n"
         "minimum_sharpness_to_record = 0\nminimum_fine_contrast = 0\nmaximum_debris = 1\n"
         "maximum_frost = 1\nmaximum_glare = 1\nmaximum_shade = 1\n"
         "maximum_blurred_part = 1\nmaximum_unevenness = 10\n"
         "maximum_colour_cast = 10\nmaximum_brightness_change = 10\n";
}

}  // namespace

SimulatedRig::SimulatedRig(const RigPlan& plan) : plan_(plan), stage_(plan.listen) {
  write_twin_configuration();
  phantom_ = std::make_unique<sim::Phantom>(
      sim::read_configuration(bridge::CheckedTable::read_file(folder() / "sim.toml")).phantom);
  start_twin();
  twin_listeners_ = sockets_of(twin_->pid());
  write_twin_configuration();  // with the address that it has found
  write_daemon_configuration();
}

void SimulatedRig::write_twin_configuration() const {
  write_text(folder() / "sim.toml",
             "seed = 7\ntime_scale = " + std::to_string(plan_.time_scale) +
                 "\nstate_file = \"controller.json\"\nwitness_log = \"witness.jsonl\"\n"
                 "[stage]\nlisten = \"" +
                 stage_ + "\"\nregister_map = \"" BIOTOMY_REGISTER_MAP "\"\n" +
                 plan_.twin_stage_settings +
                 "[rig]\nsocket = \"unix://rig.socket\"\n[camera]\nwidth = " +
                 std::to_string(plan_.width) + "\nheight = " + std::to_string(plan_.height) +
                 "\npixel = " + std::to_string(plan_.pixel_um) + "\ncolumn_offset = " +
                 std::to_string(kColumnOffsetUm) + "\n" + plan_.twin_camera_settings +
                 "[block]\nfirst_face = " + std::to_string(plan_.first_face_um) + "\n" +
                 plan_.twin_block_settings);
}

void SimulatedRig::write_daemon_configuration() const {
  write_text(folder() / "rig.toml",
             "[stage]\nendpoint = \"" + (plan_.line_between ? plan_.line_between(stage_) : stage_) +
                 "\"\nregister_map = \"" BIOTOMY_REGISTER_MAP "\"\n" + plan_.daemon_stage_settings +
                 "[lines]\nbackend = \"socket\"\nendpoint = \"unix://rig.socket\"\n"
                 "response_timeout_ms = 5000\n"  // a machine that is busy presses no e-stop
                 "[camera]\n" +
                 plan_.daemon_camera + plan_.daemon_camera_settings +
                 "[job]\nsample = \"sample\"\nlayers = " + std::to_string(plan_.layers) +
                 "\nlayer_thickness_um = " + std::to_string(plan_.layer_thickness_um) +
                 "\npixel_um = [" + std::to_string(plan_.pixel_um) + ", " +
                 std::to_string(plan_.pixel_um) +
                 "]\nfirst_face_um = " + std::to_string(plan_.first_face_um) +
                 "\nclear_ms = 1500\nsettle_ms = " + std::to_string(plan_.settle_ms) +
                 "\nlamp_warm_up_ms = " + std::to_string(plan_.lamp_warm_up_ms) + "\n" +
                 quality_settings(plan_) + "[focus]\nstart_um = " +
                 std::to_string(plan_.first_face_um - kColumnOffsetUm + kFocusGuessErrorUm) + "\n" +
                 plan_.daemon_focus_settings +
                 "[service]\nlisten = \"127.0.0.1:0\"\ntoken_file = \"token\"\ntick_ms = " +
                 std::to_string(plan_.tick_ms) + "\n" + plan_.daemon_settings);
}

void SimulatedRig::start_twin() {
  twin_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{BIOTOMY_TWIN, "--config", folder() / "sim.toml"}, folder());
  const std::string ready = twin_->wait_for("ready, stage on ", seconds(20));
  stage_ = ready.substr(0, ready.find(','));
}

void SimulatedRig::kill_twin() {
  twin_->send(SIGKILL);
  twin_->wait(seconds(10));
  twin_.reset();
}

void SimulatedRig::await_idle_twin() const {
  const auto deadline = std::chrono::steady_clock::now() + seconds(20);
  while (twin_ != nullptr && sockets_of(twin_->pid()) > twin_listeners_) {
    if (std::chrono::steady_clock::now() > deadline) {
      throw std::runtime_error("the twin still holds a connection");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void SimulatedRig::start_daemon() {
  launch_daemon();
  await_daemon();
}

void SimulatedRig::launch_daemon(const std::vector<std::string>& environment) {
  std::vector<std::string> command;
  if (!environment.empty()) {
    command = environment;
    command.insert(command.begin(), "/usr/bin/env");
  }
  command.insert(command.end(), {BIOTOMY_DAEMON, "--config", folder() / "rig.toml"});
  daemon_ = std::make_unique<ChildProcess>(command, folder());
}

void SimulatedRig::await_daemon() {
  url_ = "http://" + daemon_->wait_for("listening on http://", seconds(20));
}

void SimulatedRig::kill_daemon() {
  daemon_->send(SIGKILL);
  daemon_->wait(seconds(10));
  daemon_.reset();
}

void SimulatedRig::send_daemon(int signal) const {
  daemon_->send(signal);
}

Outcome SimulatedRig::await_daemon_end(seconds limit) {
  Outcome end = daemon_->wait(limit);
  daemon_.reset();
  return end;
}

Outcome SimulatedRig::end_daemon(seconds limit) {
  send_daemon(SIGTERM);
  return await_daemon_end(limit);
}

std::optional<Outcome> SimulatedRig::daemon_end() {
  return daemon_->end();
}

Outcome SimulatedRig::rig(const std::string& command, seconds limit,
                          const std::vector<std::string>& options) {
  std::vector<std::string> words{BIOTOMY_TOOL, "rig",          command,           "--url",
                                 url_,         "--token-file", folder() / "token"};
  words.insert(words.end(), options.begin(), options.end());
  return run(words, folder(), limit);
}

nlohmann::json SimulatedRig::status() {
  const Outcome outcome = run({BIOTOMY_TOOL, "rig", "status", "--json", "--url", url_}, folder());
  if (outcome.exit_code != 0) throw std::runtime_error(outcome.errors);
  return nlohmann::json::parse(outcome.output);
}

std::vector<nlohmann::json> SimulatedRig::witnessed(const std::string& event) const {
  std::vector<nlohmann::json> events;
  for (const std::string& line : witness_lines(witness())) {
    nlohmann::json entry = nlohmann::json::parse(line);
    if (entry.at("event") == event) events.push_back(std::move(entry));
  }
  return events;
}

}  // namespace biotomy::tests
