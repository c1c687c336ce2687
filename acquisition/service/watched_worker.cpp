#include "acquisition/service/watched_worker.hpp"

#include <mutex>
#include <utility>

namespace biotomy::acquisition {

struct WatchedWorker::State {
  Clock clock;
  std::mutex mutex;
  std::optional<TimePoint> busy_since;

  void set(std::optional<TimePoint> since) {
    const std::scoped_lock lock(mutex);
    busy_since = since;
  }
};

WatchedWorker::WatchedWorker(Worker& worker, Clock clock)
    : worker_(worker), state_(std::make_shared<State>()) {
  state_->clock = std::move(clock);
}

void WatchedWorker::post(std::function<void()> task) {
  worker_.post([state = state_, task = std::move(task)] {
    state->set(state->clock());
    task();
    state->set(std::nullopt);
  });
}

std::optional<TimePoint> WatchedWorker::busy_since() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->busy_since;
}

}  // namespace biotomy::acquisition
