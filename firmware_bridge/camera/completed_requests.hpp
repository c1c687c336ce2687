#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>

#include <libcamera/request.h>

namespace biotomy::bridge {

/// The requests that came back, from libcamera's thread to ours. What libcamera calls does nothing
/// but enqueue, and the lock is never held while libcamera is called.
class CompletedRequests {
 public:
  using Clock = std::chrono::steady_clock;

  void push(libcamera::Request* request) {
    const std::lock_guard lock(mutex_);
    requests_.push_back(request);
    arrived_.notify_one();
  }

  /// The camera was unplugged.
  void go() {
    const std::lock_guard lock(mutex_);
    is_gone_ = true;
    arrived_.notify_one();
  }

  bool is_gone() {
    const std::lock_guard lock(mutex_);
    return is_gone_;
  }

  /// The next, or null if there was none by `deadline` or the camera is gone.
  libcamera::Request* pop(Clock::time_point deadline) {
    std::unique_lock lock(mutex_);
    arrived_.wait_until(lock, deadline, [&] { return !requests_.empty() || is_gone_; });
    if (requests_.empty()) return nullptr;
    libcamera::Request* request = requests_.front();
    requests_.pop_front();
    return request;
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<libcamera::Request*> requests_;
  bool is_gone_ = false;
};

}  // namespace biotomy::bridge
