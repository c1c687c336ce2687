#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {

/// A twin on this computer, and the ends of the lines to the one that runs the daemon (KernelRig).
class RemoteRig {
 public:
  explicit RemoteRig(const RigPlan& plan);

  /// What plugs the lines into a Machine that may write to `folder`. Each call lays new cables; the
  /// earlier ones are gone.
  std::vector<std::string> plugged_in(const std::filesystem::path& folder);

  SimulatedRig& rig() { return rig_; }

 private:
  std::string lay_cable(const std::filesystem::path& frames);

  SimulatedRig rig_;
  std::vector<std::unique_ptr<ChildProcess>> cables_;
};

}  // namespace biotomy::tests
