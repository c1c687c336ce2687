#include "reconstruct/whole_loop.hpp"

#include <atomic>
#include <stdexcept>

#include <gtest/gtest.h>

namespace biotomy::reconstruct {
namespace {

TEST(WholeLoop, IsDoneToItsEndWithinAWorkThatIsCancelled) {
  std::atomic<int> calls{0};
  tbb::task_group_context outer;
  tbb::parallel_for(
      0, 1,
      [&](int) {
        outer.cancel_group_execution();
        whole_loop(1000, [&](std::size_t) { ++calls; });
      },
      outer);
  EXPECT_EQ(calls, 1000);
}

TEST(WholeLoop, ThrowsWhatItsBodyThrew) {
  EXPECT_THROW(whole_loop(10,
                          [](std::size_t i) {
                            if (i == 7) throw std::runtime_error("seven");
                          }),
               std::runtime_error);
}

}  // namespace
}  // namespace biotomy::reconstruct
