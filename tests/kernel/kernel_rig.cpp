#include "tests/kernel/kernel_rig.hpp"

#include <csignal>
#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/faults/status_watch.hpp"
#include "tests/kernel/video_devices.hpp"

namespace biotomy::tests {

namespace {

using std::chrono::seconds;

constexpr const char* kCameraModel = "Biotomy rig camera";
constexpr const char* kChip = "rig";
constexpr double kColumnOffsetUm = 350;  // of the twin (simulated_rig)
constexpr double kFocusGuessErrorUm = 25;

std::string number(double value) {
  return std::to_string(value);
}

}  // namespace

KernelRig::KernelRig(const std::filesystem::path& folder, const RigPlan& plan)
    : folder_(folder),
      plan_(plan),
      chip_(kChip, {"ESTOP", "DOOR", "LAMP"}),
      camera_socket_(lay_cable("/dev/ttyS1")),
      bench_(lay_cable("/dev/ttyS3")),
      wires_(std::make_unique<RigWires>(chip_, lay_cable("/dev/ttyS2"))),
      person_([this](const std::string& command) { return rig(command); },
              [this] { return status(); }) {
  plug_in_camera();
  write_configuration();
}

std::filesystem::path KernelRig::lay_cable(const std::string& terminal) {
  const auto socket = sockets_ / std::filesystem::path(terminal).filename();
  cables_.push_back(std::make_unique<ChildProcess>(
      std::vector<std::string>{BIOTOMY_RIG_CABLE, "--socket", socket, "--line", terminal},
      sockets_.path()));
  cables_.back()->wait_for("ready", seconds(20));
  return socket;
}

void KernelRig::plug_in_camera() {
  camera_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{
          BIOTOMY_USB_CAMERA, "--rig", camera_socket_, "--model", kCameraModel, "--size",
          std::to_string(plan_.width) + "x" + std::to_string(plan_.height), "--fps", "15"},
      sockets_.path());
  await_video_device(kCameraModel, true);
}

void KernelRig::unplug_camera() {
  camera_.reset();
  await_video_device(kCameraModel, false);
}

void KernelRig::write_configuration() const {
  const auto line = [](const char* role, const char* name) {
    return std::string("[lines.") + role + "]\nchip = \"" + kChip + "\"\nline = \"" + name + "\"\n";
  };
  std::ofstream(folder_ / "rig.toml")
      << "[stage]\nendpoint = \"rtu:///dev/ttyS0\"\nregister_map = \"" BIOTOMY_REGISTER_MAP "\"\n" +
             plan_.daemon_stage_settings + "[lines]\nbackend = \"gpiod\"\n" +
             line("estop", "ESTOP") + line("door", "DOOR") + line("lamp", "LAMP") +
             "[camera]\nbackend = \"libcamera\"\ncamera = \"" + kCameraModel +
             "\"\nexposure_us = 10000\n" + plan_.daemon_camera_settings +
             "[job]\nsample = \"sample\"\nlayers = " + std::to_string(plan_.layers) +
             "\nlayer_thickness_um = " + number(plan_.layer_thickness_um) + "\npixel_um = [" +
             number(plan_.pixel_um) + ", " + number(plan_.pixel_um) +
             "]\nfirst_face_um = " + number(plan_.first_face_um) +
             "\nclear_ms = 1500\nsettle_ms = " + std::to_string(plan_.settle_ms) +
             "\nlamp_warm_up_ms = " + std::to_string(plan_.lamp_warm_up_ms) +
             "\n[focus]\nstart_um = " +
             number(plan_.first_face_um - kColumnOffsetUm + kFocusGuessErrorUm) +
             "\n[service]\nlisten = \"127.0.0.1:0\"\ntoken_file = \"token\"\ntick_ms = " +
             std::to_string(plan_.tick_ms) + "\n" + plan_.daemon_settings;
}

void KernelRig::start_daemon() {
  daemon_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{BIOTOMY_DAEMON, "--config", folder_ / "rig.toml"}, folder_);
  url_ = "http://" + daemon_->wait_for("listening on http://", seconds(60));
}

Outcome KernelRig::end_daemon() {
  daemon_->send(SIGTERM);
  Outcome end = daemon_->wait(seconds(120));
  daemon_.reset();
  return end;
}

Outcome KernelRig::rig(const std::string& command) {
  return run({BIOTOMY_TOOL, "rig", command, "--url", url_, "--token-file", folder_ / "token"},
             sockets_.path());
}

nlohmann::json KernelRig::status() {
  return StatusWatch(url_).look();
}

}  // namespace biotomy::tests
