#pragma once

#include <chrono>
#include <filesystem>
#include <set>

#include "firmware_bridge/lines/lines.hpp"
#include "firmware_bridge/wire/rig_client.hpp"

namespace biotomy::bridge {

/// The lines of a rig in another process, over the rig's socket (wire/README.md). Connects at the
/// first call and, after a failure, at the next. Inputs that can't be had are reported unsafe.
class SocketLines final : public Lines {
 public:
  /// `time_out` limits every call. Throws nothing about the peer: that it is not there yet is for
  /// the calls to tell.
  SocketLines(const std::filesystem::path& socket, std::chrono::milliseconds time_out);
  ~SocketLines() override;

  SafetyInputs read_inputs() override;
  void set(OutputRole role, bool on) override;

 private:
  RigClient client_;
  std::chrono::milliseconds time_out_;
  std::set<OutputRole> switched_on_;  ///< what the destructor has to switch off
};

}  // namespace biotomy::bridge
