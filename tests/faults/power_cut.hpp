#pragma once

#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "acquisition/settings/job_settings.hpp"
#include "tests/faults/recorded_disk.hpp"
#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {

/// A job that came to its end, whose sample's disk was recorded: what a daemon would find, were the
/// power of the whole machine cut at any moment of it. The controller has a supply and a memory of
/// its own.
class PowerCuts {
 public:
  /// `log` is the recording of `rig`'s sample.
  PowerCuts(const SimulatedRig& rig, RecordedDisk disk);

  const RecordedDisk& disk() const { return disk_; }
  PowerCuts without_sync(std::size_t call) const;

  /// What is wrong with the sample after a cut behind the first `cut` calls, a sentence each, as a
  /// daemon that opens it finds it. Right is:
  /// - each layer is there, with its hash, if the grind of the one below it had been sent;
  /// - each layer that the journal has as committed has the hash that it says, and the pixels of
  /// the
  ///   finished run's;
  /// - journal and controller agree on where the job goes on, and it is neither a layer that was
  ///   ground already nor one that was skipped;
  /// - the volume can be opened and gone on with; unless it may be lost, as `biotomy
  ///   rebuild` makes it anew from the layers.
  enum class Volume { kept, lost };
  std::vector<std::string> complaints(std::size_t cut, PowerLoss loss, std::mt19937& random,
                                      Volume volume = Volume::kept) const;

  /// The last call that had been done when the command to grind `layer` was sent.
  std::size_t call_before_grind(std::int64_t layer) const;

 private:
  /// A pass that was finished; the n-th is of layer n. The times are rounded down to milliseconds.
  struct Pass {
    std::int64_t begun_ns = 0;
    std::int64_t finished_ns = 0;
  };
  class Opened;

  std::filesystem::path scratch_;
  acquisition::JobSettings settings_;
  int width_ = 0;
  int height_ = 0;
  std::vector<Pass> passes_;         ///< in their order
  std::vector<std::string> hashes_;  ///< of the finished run's layers
  RecordedDisk disk_;
};

}  // namespace biotomy::tests
