#include "acquisition/http/work_lane.hpp"

#include <atomic>
#include <future>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;

bool never() {
  return false;
}

/// Keeps one thread of a lane busy until it is told otherwise.
class Hold {
 public:
  explicit Hold(WorkLane& lane) {
    std::promise<void> begun;
    lane.post({.run =
                   [this, &begun] {
                     begun.set_value();
                     end_.get_future().wait();
                   },
               .is_useless = never});
    begun.get_future().wait();
  }
  void end() { end_.set_value(); }

 private:
  std::promise<void> end_;
};

TEST(WorkLane, RefusesWhatIsMoreThanItsQueueHolds) {
  WorkLane lane("test", 1, 2, 0);
  Hold hold(lane);
  std::atomic<int> run = 0;
  const WorkLane::Task count{.run = [&] { ++run; }, .is_useless = never};
  EXPECT_TRUE(lane.post(count));
  EXPECT_TRUE(lane.post(count));
  EXPECT_FALSE(lane.post(count));
  std::promise<void> last;
  lane.go_on({.run = [&] { last.set_value(); }, .is_useless = never});  // work taken on before
  hold.end();
  last.get_future().wait();
  EXPECT_EQ(run, 2);
}

TEST(WorkLane, MakesRoomOfWhatNobodyWaitsForAnyMore) {
  WorkLane lane("test", 1, 1, 0);
  Hold hold(lane);
  bool useless_was_run = false;
  std::atomic<bool> left = false;
  EXPECT_TRUE(lane.post(
      {.run = [&] { useless_was_run = true; }, .is_useless = [&] { return left.load(); }}));
  EXPECT_FALSE(lane.post({.run = [] {}, .is_useless = never}));
  left = true;
  std::promise<void> last;
  EXPECT_TRUE(lane.post({.run = [&] { last.set_value(); }, .is_useless = never}));
  hold.end();
  last.get_future().wait();
  EXPECT_FALSE(useless_was_run);
}

TEST(WorkLane, DropsWhatWaitsWhenItEnds) {
  std::atomic<bool> was_run = false;
  std::promise<void> begun;
  std::promise<void> ready;
  {
    WorkLane lane("test", 1, 2, 0);
    lane.post({.run =
                   [&] {
                     begun.set_value();
                     ready.get_future().wait();
                     // Until the lane takes no more, as it is ending.
                     while (lane.post({.run = [] {}, .is_useless = [] { return true; }})) {
                     }
                   },
               .is_useless = never});
    begun.get_future().wait();
    lane.post({.run = [&] { was_run = true; }, .is_useless = never});
    ready.set_value();
  }
  EXPECT_FALSE(was_run);
}

TEST(WorkLane, WorksWithLowerPriorityWhereThatIsAsked) {
  const int own = ::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()));
  WorkLane lane("test", 1, 5, 5);
  std::promise<int> theirs;
  lane.post(
      {.run = [&] { theirs.set_value(::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()))); },
       .is_useless = never});
  EXPECT_EQ(theirs.get_future().get(), std::min(own + 5, 19));
  EXPECT_EQ(::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid())), own);
}

}  // namespace
}  // namespace biotomy::tests
