#include "acquisition/service/helping_threads.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

namespace biotomy::acquisition {
namespace {

constexpr std::chrono::seconds kPatience{1};  // where TBB has fewer threads than it says

}  // namespace

void start_helping_threads() {
  const int all = tbb::this_task_arena::max_concurrency();
  const auto limit = std::chrono::steady_clock::now() + kPatience;
  std::mutex mutex;
  std::condition_variable changed;
  int there = 0;
  // Each waits for all the others, so that none does the work of two.
  const auto meet = [&](int) {
    std::unique_lock lock(mutex);
    ++there;
    changed.notify_all();
    changed.wait_until(lock, limit, [&] { return there >= all; });
  };
  tbb::parallel_for(0, all, meet, tbb::simple_partitioner());
}

}  // namespace biotomy::acquisition
