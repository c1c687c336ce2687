#include "acquisition/service/helping_threads.hpp"

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <sys/resource.h>
#include <unistd.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;

int own_priority() {
  return ::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()));
}

// In a process of its own, as ctest runs it: TBB's threads are made once.
TEST(HelpingThreads, KeepThePriorityOfWhoStartedThemWhoeverNeedsThem) {
  start_helping_threads();
  const int processors = cv::getNumThreads();
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  std::mutex mutex;
  std::condition_variable changed;
  std::map<pid_t, int> helpers;  // their priorities
  std::thread asking([&] {
    const pid_t own = ::gettid();
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(own), own_priority() + 5);
    cv::parallel_for_({0, processors}, [&](const cv::Range&) {
      std::unique_lock lock(mutex);
      if (::gettid() != own) helpers[::gettid()] = own_priority();
      changed.notify_all();
      changed.wait_until(lock, limit, [&] { return !helpers.empty() || processors == 1; });
    });
  });
  asking.join();
  EXPECT_EQ(helpers.empty(), processors == 1);
  for (const auto& [thread, priority] : helpers) EXPECT_EQ(priority, own_priority());
}

}  // namespace
}  // namespace biotomy::tests
