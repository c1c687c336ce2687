#pragma once

#include <filesystem>
#include <string>

#include "firmware_bridge/wire/rig_client.hpp"

namespace biotomy::tests {

/// The hands of a person at the twin: breaks things, mends them, presses and opens.
/// Throws what RigClient throws.
class RigBench {
 public:
  explicit RigBench(const std::filesystem::path& socket);

  /// `event`: the TOML text of an event's table (sim/README.md).
  void begin_fault(const std::string& name, const std::string& event);
  void end_fault(const std::string& name);
  void set_input(bridge::RigInput input, bool on);

 private:
  bridge::RigClient client_;
};

}  // namespace biotomy::tests
