#include "acquisition/http/work_lane.hpp"

#include <utility>

#include <pthread.h>

#include "acquisition/low_priority.hpp"

namespace biotomy::acquisition {

WorkLane::WorkLane(const std::string& name, int threads, std::size_t most_waiting, int nice)
    : most_waiting_(most_waiting) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([=, this] { work(name, nice); });
}

WorkLane::~WorkLane() {
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
    waiting_.clear();
  }
  woken_.notify_all();
}

bool WorkLane::post(Task task) {
  {
    const std::scoped_lock lock(mutex_);
    if (waiting_.size() >= most_waiting_) {
      std::erase_if(waiting_, [](const Task& waiting) { return waiting.is_useless(); });
    }
    if (waiting_.size() >= most_waiting_ || ending_) return false;
    waiting_.push_back(std::move(task));
  }
  woken_.notify_one();
  return true;
}

void WorkLane::go_on(Task task) {
  {
    const std::scoped_lock lock(mutex_);
    if (ending_) return;
    waiting_.push_back(std::move(task));
  }
  woken_.notify_one();
}

void WorkLane::work(const std::string& name, int nice) {
  ::pthread_setname_np(::pthread_self(), name.c_str());
  if (nice > 0) lower_priority(nice, DiskShare::last);
  while (true) {
    Task task;
    {
      std::unique_lock lock(mutex_);
      woken_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
      if (ending_) return;
      task = std::move(waiting_.front());
      waiting_.pop_front();
    }
    if (!task.is_useless()) task.run();
  }
}

}  // namespace biotomy::acquisition
