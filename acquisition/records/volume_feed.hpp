#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "acquisition/worker.hpp"

namespace biotomy::acquisition {

/// Puts committed layers into the volume, on a worker of its own, never in the rig's way. A failure
/// is told and tried again with the next layer; it stops nothing, since the layers are safe and the
/// volume can be made anew from them.
/// `offer`, `finish` and `progress` may be called from any thread and never wait.
class VolumeFeed {
 public:
  /// As reconstruct::VolumeWriter::append.
  using Append = std::function<void(std::int64_t available, bool finish,
                                    const std::function<void(std::int64_t)>& progress)>;

  struct Progress {
    std::int64_t layers_present = 0;  ///< in the volume
    bool finished = false;            ///< all that `finish` named are in it
    std::string failure;              ///< of the last append; empty when it went well
  };

  /// The worker outlives the feed's last task.
  VolumeFeed(Worker& worker, Append append);

  /// Layers 1 to `available` are committed.
  void offer(std::int64_t available);

  /// Likewise, and there will be no more.
  void finish(std::int64_t available);

  Progress progress() const;

 private:
  struct State;
  void post();

  Worker& worker_;
  std::shared_ptr<State> state_;
};

}  // namespace biotomy::acquisition
