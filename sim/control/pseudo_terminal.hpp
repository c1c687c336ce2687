#pragma once

#include <filesystem>

#include "firmware_bridge/wire/unique_fd.hpp"

namespace biotomy::sim {

/// A serial line without a wire: a pseudo-terminal, with a symbolic link at a path of one's choice
/// by which others open it as a serial device. What they write is read here and the other way
/// round, raw bytes. Whether anybody has it open can't be seen here. The link goes with the object;
/// who still has the device open finds it gone (EIO).
class PseudoTerminal {
 public:
  /// Takes the place of a symbolic link that is there, such as one left by a killed process, but of
  /// nothing else. Throws std::system_error.
  explicit PseudoTerminal(const std::filesystem::path& link);
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// This end, non-blocking.
  int descriptor() const { return near_.get(); }

 private:
  std::filesystem::path link_;
  std::filesystem::path device_;
  bridge::UniqueFd near_;
  bridge::UniqueFd far_;  ///< held open, so that nobody else's closing hangs the line up
};

}  // namespace biotomy::sim
