#include "acquisition/job/control_loop.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace biotomy::acquisition {

struct ControlLoop::State {
  std::chrono::milliseconds period{0};
  std::function<void(TimePoint)> tick;
  std::function<void(const char*)> failed;
  std::mutex mutex;
  std::condition_variable ended;
  bool ending = false;
  std::thread thread;

  void run() {
    TimePoint next = std::chrono::steady_clock::now();
    std::unique_lock lock(mutex);
    while (!ending) {
      lock.unlock();
      try {
        tick(std::chrono::steady_clock::now());
      } catch (const std::exception& error) {
        failed(error.what());
        return;
      }
      next = std::max(next + period, std::chrono::steady_clock::now());
      lock.lock();
      ended.wait_until(lock, next, [this] { return ending; });
    }
  }
};

ControlLoop::ControlLoop(std::chrono::milliseconds period, std::function<void(TimePoint)> tick,
                         std::function<void(const char*)> failed)
    : state_(std::make_unique<State>()) {
  state_->period = period;
  state_->tick = std::move(tick);
  state_->failed = std::move(failed);
  state_->thread = std::thread([state = state_.get()] { state->run(); });
}

ControlLoop::~ControlLoop() {
  {
    const std::scoped_lock lock(state_->mutex);
    state_->ending = true;
  }
  state_->ended.notify_one();
  state_->thread.join();
}

}  // namespace biotomy::acquisition
