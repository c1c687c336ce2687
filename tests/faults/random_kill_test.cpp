#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <thread>

#include <gmock/gmock.h>

#include "tests/faults/killed_run.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

int setting(const char* name, int fallback) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : fallback;
}

/// What is killed, and how often, is set by the environment: BIOTOMY_KILLS, and BIOTOMY_KILL_SEED
/// to repeat a run's instants.
class RandomKills : public testing::Test {
 protected:
  RandomKills() {
    std::cout << "BIOTOMY_KILLS=" << kills_ << " BIOTOMY_KILL_SEED=" << seed_ << std::endl;
  }

  bool chance(int one_in) { return std::uniform_int_distribution<int>(1, one_in)(random_) == 1; }

  microseconds up_to(microseconds most) {
    return microseconds(std::uniform_int_distribution<std::int64_t>(0, most.count())(random_));
  }

  const int kills_ = setting("BIOTOMY_KILLS", 30);
  const unsigned seed_ =
      static_cast<unsigned>(setting("BIOTOMY_KILL_SEED", static_cast<int>(std::random_device()())));
  std::mt19937 random_{seed_};
};

TEST_F(RandomKills, OfTheDaemonLeaveTheStackOfAnUndisturbedRun) {
  const RigPlan plan{.width = 80, .height = 64, .layers = 60};
  UndisturbedRun undisturbed(plan);
  for (int kills = 0; kills < kills_;) {
    KilledRun run(plan);
    std::int64_t committed = 0;
    for (int in_vain = 0; kills < kills_ && committed < plan.layers; ++kills) {
      const bool at_launch = chance(4);
      // Where nothing is committed any more, the machine is slow: give it more time.
      const microseconds time =
          at_launch ? up_to(milliseconds(200)) : up_to(milliseconds(500) * (1 + in_vain / 4));
      run.run_daemon_for(at_launch ? KilledRun::From::launch : KilledRun::From::work, time);
      in_vain = run.committed() > committed ? 0 : in_vain + 1;
      committed = run.committed();
    }
    run.rig().start_daemon();
    run.finish();
    EXPECT_THAT(run.verdict(undisturbed.sample()), testing::IsEmpty());
    EXPECT_THAT(run.alarms(), testing::IsEmpty());
  }
}

}  // namespace
}  // namespace biotomy::tests
