#include "reconstruct/disk/write_behind.hpp"

#include <utility>

namespace biotomy::reconstruct {

WriteBehind::WriteBehind(std::size_t most_bytes, int threads) : most_bytes_(most_bytes) {
  try {
    for (int i = 0; i < threads; ++i) {
      threads_.emplace_back([this] { work(); });
    }
  } catch (...) {
    stop();  // those that were started, for which no destructor runs
    throw;
  }
}

WriteBehind::~WriteBehind() {
  stop();
}

void WriteBehind::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void WriteBehind::add(std::size_t bytes, std::function<void()> store) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] {
    return failure_ != nullptr || unfinished_ == 0 || bytes_ + bytes <= most_bytes_;
  });
  if (failure_) {
    std::rethrow_exception(failure_);
  }
  waiting_.push_back({bytes, std::move(store)});
  bytes_ += bytes;
  ++unfinished_;
  lock.unlock();
  changed_.notify_all();
}

void WriteBehind::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return unfinished_ == 0 || failure_ != nullptr; });
  if (failure_) {
    std::rethrow_exception(failure_);
  }
}

void WriteBehind::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return stopping_ || (!waiting_.empty() && failure_ == nullptr); });
    if (stopping_) {
      return;
    }
    Task task = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    std::exception_ptr failure;
    try {
      task.store();
    } catch (...) {
      failure = std::current_exception();
    }
    task.store = {};  // its bytes go before there is room for others
    lock.lock();
    bytes_ -= task.bytes;
    --unfinished_;
    if (failure && !failure_) {
      failure_ = failure;
    }
    changed_.notify_all();
  }
}

}  // namespace biotomy::reconstruct
