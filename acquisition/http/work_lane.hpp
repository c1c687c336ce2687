#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace biotomy::acquisition {

/// Threads that do one kind of work, with a queue of limited length before them.
class WorkLane {
 public:
  struct Task {
    std::function<void()> run;         ///< must not throw
    std::function<bool()> is_useless;  ///< any more; it is then dropped without being run
  };

  /// `name` is the threads' in lists of processes; `nice` is added to their niceness, and with it
  /// goes a lower priority for the disk.
  WorkLane(const std::string& name, int threads, std::size_t most_waiting, int nice);
  /// Drops what waits, and waits for what is being done.
  ~WorkLane();
  WorkLane(const WorkLane&) = delete;
  WorkLane& operator=(const WorkLane&) = delete;

  /// False when the queue is full.
  bool post(Task task);

  /// The next part of work that was taken on before: never refused.
  void go_on(Task task);

 private:
  void work(const std::string& name, int nice);

  std::mutex mutex_;
  std::condition_variable woken_;
  std::deque<Task> waiting_;
  std::size_t most_waiting_;
  bool ending_ = false;
  std::vector<std::jthread> threads_;  // last: they use all the rest
};

}  // namespace biotomy::acquisition
