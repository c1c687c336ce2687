#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "acquisition/rig/step_failure.hpp"
#include "acquisition/worker.hpp"

namespace biotomy::acquisition {

/// A worker of which it is known how long it has been at its task.
class WatchedWorker final : public Worker {
 public:
  using Clock = std::function<TimePoint()>;

  /// The worker outlives it, and what it posts may outlive this object.
  WatchedWorker(Worker& worker, Clock clock);

  void post(std::function<void()> task) override;

  /// Since when it has been at the task at hand; nothing when it waits for one. For any thread.
  std::optional<TimePoint> busy_since() const;

 private:
  struct State;
  Worker& worker_;
  std::shared_ptr<State> state_;
};

}  // namespace biotomy::acquisition
