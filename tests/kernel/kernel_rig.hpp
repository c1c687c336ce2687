#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tests/faults/rig_bench.hpp"
#include "tests/faults/rig_operator.hpp"
#include "tests/integration/child_process.hpp"
#include "tests/integration/simulated_rig.hpp"
#include "tests/kernel/gpio_sim_chip.hpp"
#include "tests/kernel/rig_wires.hpp"

namespace biotomy::tests {

/// On the kernel: the daemon and its devices, which are the kernel's own. Its serial line ttyS0
/// goes to the controller of a rig on the other computer; ttyS1, ttyS2 and ttyS3 are cables to its
/// camera, its lines and its bench. All ends when the object goes.
class KernelRig {
 public:
  /// `folder`: of the configuration and the sample; it may hold those of an earlier run.
  KernelRig(const std::filesystem::path& folder, const RigPlan& plan);

  void start_daemon();

  /// SIGTERM, and waits for the end.
  Outcome end_daemon();

  /// How it ended by itself; nothing while it runs.
  std::optional<Outcome> daemon_end() { return daemon_->end(); }

  const std::string& url() const { return url_; }
  Outcome rig(const std::string& command);

  /// In this process: to begin another takes as long here as some steps of the job.
  nlohmann::json status();

  RigOperator& person() { return person_; }
  RigBench& bench() { return bench_; }
  GpioSimChip& chip() { return chip_; }
  RigWires& wires() { return *wires_; }

  void plug_in_camera();
  void unplug_camera();

  std::filesystem::path sample() const { return folder_ / "sample"; }

 private:
  std::filesystem::path lay_cable(const std::string& terminal);
  void write_configuration() const;

  std::filesystem::path folder_;
  RigPlan plan_;
  TemporaryFolder sockets_;
  std::vector<std::unique_ptr<ChildProcess>> cables_;
  GpioSimChip chip_;
  std::filesystem::path camera_socket_;
  RigBench bench_;
  std::unique_ptr<RigWires> wires_;
  std::unique_ptr<ChildProcess> camera_;
  std::unique_ptr<ChildProcess> daemon_;
  RigOperator person_;
  std::string url_;
};

}  // namespace biotomy::tests
