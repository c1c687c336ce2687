#pragma once

#include <filesystem>
#include <optional>

#include "sim/control/controller.hpp"
#include "sim/physics/mechanics.hpp"

namespace biotomy::sim {

/// What outlives the twin's process: the controller's permanent memory, and the machine with
/// the block as it stands.
struct RigState {
  ControllerMemory memory;
  Mechanics::State machine;
};

/// The state in a JSON file. It is written beside, synchronised and renamed over the old one, so
/// that there is always one whole state, however the twin ends.
class StateFile {
 public:
  /// An empty path: nothing is kept.
  explicit StateFile(std::filesystem::path file) : file_(std::move(file)) {}

  /// None if there is no file. Throws std::runtime_error if it can't be read or is damaged.
  std::optional<RigState> read() const;

  /// Throws std::system_error.
  void write(const RigState& state) const;

 private:
  std::filesystem::path file_;
};

}  // namespace biotomy::sim
