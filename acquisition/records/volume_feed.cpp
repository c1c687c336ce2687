#include "acquisition/records/volume_feed.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

#include "acquisition/log.hpp"

namespace biotomy::acquisition {

struct VolumeFeed::State {
  explicit State(Append append_function) : append(std::move(append_function)) {}

  Append append;
  std::mutex mutex;
  std::int64_t available = 0;
  bool finish = false;
  bool task_waits = false;
  Progress progress;

  void run() {
    std::int64_t layers = 0;
    bool last = false;
    {
      const std::scoped_lock lock(mutex);
      task_waits = false;
      layers = available;
      last = finish;
    }
    std::string failure;
    try {
      append(layers, last, [this](std::int64_t written) {
        const std::scoped_lock lock(mutex);
        progress.layers_present = written;
      });
    } catch (const std::exception& error) {
      failure = error.what();
      log_error("volume", failure);
    }
    const std::scoped_lock lock(mutex);
    progress.failure = failure;
    progress.finished = last && failure.empty();
  }
};

VolumeFeed::VolumeFeed(Worker& worker, Append append)
    : worker_(worker), state_(std::make_shared<State>(std::move(append))) {}

void VolumeFeed::offer(std::int64_t available) {
  {
    const std::scoped_lock lock(state_->mutex);
    state_->available = std::max(state_->available, available);
  }
  post();
}

void VolumeFeed::finish(std::int64_t available) {
  {
    const std::scoped_lock lock(state_->mutex);
    state_->available = std::max(state_->available, available);
    state_->finish = true;
  }
  post();
}

VolumeFeed::Progress VolumeFeed::progress() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->progress;
}

void VolumeFeed::post() {
  {
    const std::scoped_lock lock(state_->mutex);
    if (state_->task_waits) return;
    state_->task_waits = true;
  }
  worker_.post([state = state_] { state->run(); });
}

}  // namespace biotomy::acquisition
