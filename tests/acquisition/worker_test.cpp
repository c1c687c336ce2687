#include "acquisition/worker.hpp"

#include <numeric>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

TEST(ThreadWorker, FinishesWhatWasPostedInItsOrderBeforeItEnds) {
  constexpr int kTasks = 100;
  std::vector<int> done;
  {
    ThreadWorker worker;
    for (int i = 0; i < kTasks; ++i) worker.post([&done, i] { done.push_back(i); });
  }
  std::vector<int> expected(kTasks);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(done, expected);
}

TEST(ThreadWorker, HandsBackWhatATaskGivesAndWhatItThrows) {
  ThreadWorker worker;
  EXPECT_EQ(run_on(worker, [] { return 42; }).get(), 42);
  auto failed = run_on(worker, []() -> int { throw std::runtime_error("no disk"); });
  EXPECT_THROW(failed.get(), std::runtime_error);
  EXPECT_EQ(run_on(worker, [] { return 43; }).get(), 43) << "and goes on";
}

}  // namespace
}  // namespace biotomy::acquisition
