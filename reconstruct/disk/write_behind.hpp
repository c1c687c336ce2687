#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace biotomy::reconstruct {

/// Threads that wait for the disk so that those that compute need not. What waits to be stored is
/// bounded by bytes. After the first failure nothing more is begun; it is thrown by the next call.
class WriteBehind {
 public:
  /// `most_bytes`: of all that is waiting and being stored; a single larger task is let through.
  WriteBehind(std::size_t most_bytes, int threads);

  /// What was not begun yet is dropped.
  ~WriteBehind();
  WriteBehind(const WriteBehind&) = delete;
  WriteBehind& operator=(const WriteBehind&) = delete;

  /// `store` stores `bytes` bytes that it owns. Waits until there is room for it. With several
  /// threads, tasks do not end in the order in which they were added.
  void add(std::size_t bytes, std::function<void()> store);

  /// Waits until all is stored.
  void finish();

 private:
  struct Task {
    std::size_t bytes;
    std::function<void()> store;
  };

  void work();
  void stop();

  std::size_t most_bytes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> waiting_;
  std::size_t bytes_ = 0;
  std::size_t unfinished_ = 0;
  bool stopping_ = false;
  std::exception_ptr failure_;
  std::vector<std::thread> threads_;
};

}  // namespace biotomy::reconstruct
