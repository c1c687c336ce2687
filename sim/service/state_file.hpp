#pragma once

#include <filesystem>
#include <optional>

#include "sim/control/controller.hpp"
#include "sim/physics/block.hpp"

namespace biotomy::sim {

/// What outlives the twin's process: the controller's permanent memory, and the block and the axes
/// as they stand.
struct RigState {
  ControllerMemory memory;
  Block::State block;
  double feed_um = 0;
  double traverse_um = 0;
  double column_um = 0;
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
