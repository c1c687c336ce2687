#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace biotomy::tests {

/// A pass of the wheel, from its command to its end. Times are ISO 8601, UTC.
struct WitnessedPass {
  std::uint32_t sequence = 0;
  double target_um = 0.0;
  std::string began_at;
  std::string result;  ///< done, aborted or refused; empty while it runs

  bool moved() const { return result != "refused"; }
};

/// A photograph that the twin took.
struct WitnessedFrame {
  std::uint64_t number = 0;  ///< from 1 since the twin's start
  std::string at;
  double face_um = 0.0;
  double column_um = 0.0;
  bool face_in_view = false;
  bool lamp_on = false;
  bool spoilt = false;             ///< what the camera gave was not this photograph
  bool column_moved_next = false;  ///< as between two frames of a focus search
};

/// What the twin saw, in its order.
struct Witness {
  std::vector<WitnessedPass> passes;
  std::vector<WitnessedFrame> frames;
  std::vector<std::string> stops;  ///< when the twin was started again, and when it faulted
  std::vector<std::string> contradictions;  ///< sentences: the log does not fit itself
};

/// Reads a witness log. A twin that was killed says at its next start what became of the command
/// that it was at. Throws std::runtime_error when a line is no event.
Witness read_witness(const std::filesystem::path& log);

}  // namespace biotomy::tests
