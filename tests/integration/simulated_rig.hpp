#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sim/phantom/phantom.hpp"
#include "tests/integration/child_process.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {

/// The job that a simulated rig is given, and the specimen in it.
struct RigPlan {
  int width = 160;
  int height = 120;
  int layers = 36;  ///< a whole band of the volume and a part of the next
  double pixel_um = 10;
  double layer_thickness_um = 20;
  double first_face_um = 1000;
  double time_scale = 200;
  std::string listen = "tcp://127.0.0.1:0";  ///< of the twin's controller
  std::string twin_stage_settings = {};      ///< lines of sim.toml's [stage]
  std::string twin_camera_settings = {};     ///< lines of sim.toml's [camera]
  std::string twin_block_settings = {};      ///< lines of sim.toml's [block]
  std::string daemon_stage_settings = {};    ///< lines of rig.toml's [stage]
  /// Which camera the daemon has: lines of rig.toml's [camera].
  std::string daemon_camera =
      "backend = \"socket\"\nendpoint = \"unix://rig.socket\"\nexposure_us = 10000\n";
  std::string daemon_camera_settings = {};  ///< more lines of it
  std::string daemon_focus_settings = {};   ///< lines of rig.toml's [focus]
  int settle_ms = 5;                        ///< real time, as the next two
  int lamp_warm_up_ms = 5;
  int tick_ms = 2;
  /// From the controller's address to that which the daemon is given; both without it.
  std::function<std::string(const std::string&)> line_between = {};
  std::string daemon_settings = {};  ///< the end of rig.toml: more keys of [service], then tables
};

/// A twin and a daemon as processes of their own, in a folder of their own; both are killed when
/// the object goes. Each of them can be killed and started again while the other goes on.
class SimulatedRig {
 public:
  explicit SimulatedRig(const RigPlan& plan);

  void start_daemon();
  void kill_daemon();

  /// The two halves of start_daemon. `environment`: NAME=VALUE, in which the daemon runs.
  void launch_daemon(const std::vector<std::string>& environment = {});
  void await_daemon();

  bool daemon_runs() const { return daemon_ != nullptr; }  ///< as far as this object has seen
  void send_daemon(int signal) const;

  /// Waits until the daemon has ended by itself. Throws std::runtime_error when time is up.
  Outcome await_daemon_end(std::chrono::seconds limit);

  /// How the daemon ended by itself; nothing while it runs.
  std::optional<Outcome> daemon_end();

  /// At the same address as before, with what it remembers.
  void start_twin();
  void kill_twin();

  /// Waits until a twin that runs holds no connection any more: what a daemon that is gone had
  /// asked of it is done and witnessed. Throws std::runtime_error when time is up.
  void await_idle_twin() const;

  /// SIGTERM, and waits for the end.
  Outcome end_daemon(std::chrono::seconds limit = std::chrono::seconds(60));

  pid_t daemon_pid() const { return daemon_->pid(); }

  /// Where the daemon listens: "http://127.0.0.1:8080".
  const std::string& url() const { return url_; }

  /// `biotomy rig COMMAND`.
  Outcome rig(const std::string& command, std::chrono::seconds limit = std::chrono::seconds(60),
              const std::vector<std::string>& options = {});

  /// The daemon's /api/v1/status.
  nlohmann::json status();

  /// Every line of the witness log with this "event".
  std::vector<nlohmann::json> witnessed(const std::string& event) const;

  std::filesystem::path folder() const { return folder_.path(); }
  std::filesystem::path witness() const { return folder_.path() / "witness.jsonl"; }
  std::filesystem::path sample() const { return folder_.path() / "sample"; }
  const RigPlan& plan() const { return plan_; }

  /// What is really in the block.
  const sim::Phantom& phantom() const { return *phantom_; }

 private:
  void write_twin_configuration() const;
  void write_daemon_configuration() const;

  RigPlan plan_;
  TemporaryFolder folder_;
  std::unique_ptr<sim::Phantom> phantom_;
  std::unique_ptr<ChildProcess> twin_;
  std::unique_ptr<ChildProcess> daemon_;
  std::string stage_;
  int twin_listeners_ = 0;  ///< sockets that the twin holds while nobody is connected
  std::string url_;
};

}  // namespace biotomy::tests
