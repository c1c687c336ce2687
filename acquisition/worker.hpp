#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <type_traits>
#include <utility>

namespace biotomy::acquisition {

/// Does what may block (the camera, the disk) one task after the other, in the order of posting,
/// away from the thread that watches the rig.
class Worker {
 public:
  virtual ~Worker() = default;
  virtual void post(std::function<void()> task) = 0;
};

/// A worker with a thread of its own. The destructor finishes what was posted.
class ThreadWorker : public Worker {
 public:
  ThreadWorker();
  ~ThreadWorker() override;
  ThreadWorker(const ThreadWorker&) = delete;
  ThreadWorker& operator=(const ThreadWorker&) = delete;

  void post(std::function<void()> task) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Posts `function` and gives the future of its result; what it throws comes out of `get`.
template <typename Function>
auto run_on(Worker& worker, Function function) {
  using Result = std::invoke_result_t<Function>;
  auto task = std::make_shared<std::packaged_task<Result()>>(std::move(function));
  std::future<Result> result = task->get_future();
  worker.post([task] { (*task)(); });
  return result;
}

template <typename Result>
bool is_ready(const std::future<Result>& future) {
  return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace biotomy::acquisition
