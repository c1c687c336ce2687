#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "acquisition/rig/step_failure.hpp"

namespace biotomy::acquisition {

/// Whether the daemon makes progress, so that it may say so to whoever watches it: the control loop
/// must have ticked since the last time, and the worker must not have been at one task for longer
/// than any task may take. `ticked` is for the control thread, the rest for one other.
class Liveness {
 public:
  using BusySince = std::function<std::optional<TimePoint>()>;

  Liveness(BusySince worker_busy_since, std::chrono::milliseconds worker_limit);

  void ticked() { ++ticks_; }
  std::uint64_t ticks() const { return ticks_; }

  /// True once for each progress.
  bool take_progress(TimePoint now);

  /// Why there is none, for the log; nothing as long as all is well.
  std::optional<std::string> complaint(TimePoint now) const;

 private:
  BusySince worker_busy_since_;
  std::chrono::milliseconds worker_limit_;
  std::atomic<std::uint64_t> ticks_{0};
  std::uint64_t taken_ = 0;
};

}  // namespace biotomy::acquisition
