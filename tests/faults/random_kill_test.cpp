#include <cstdlib>
#include <functional>
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
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

int setting(const char* name, int fallback) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : fallback;
}

/// Jobs that are killed at random instants, over and over: as often as BIOTOMY_KILLS says, at the
/// instants of BIOTOMY_KILL_SEED when that is given.
class RandomKills : public testing::Test {
 protected:
  /// One kill, within a time from when the job is at work; a killed twin is started again.
  using Kill = std::function<void(KilledRun& run, milliseconds most)>;

  void kill_over_and_over(int kills_by_default, const Kill& kill) {
    const int kills = setting("BIOTOMY_KILLS", kills_by_default);
    std::cout << "BIOTOMY_KILLS=" << kills << " BIOTOMY_KILL_SEED=" << seed_ << std::endl;
    const RigPlan plan{.width = 80, .height = 64, .layers = 60};
    UndisturbedRun undisturbed(plan);
    for (int done = 0; done < kills;) {
      KilledRun run(plan);
      std::int64_t committed = 0;
      // Where nothing is committed any more, the machine is slow: give it more time.
      for (int in_vain = 0; done < kills && committed < plan.layers; ++done) {
        kill(run, milliseconds(500) * (1 + in_vain / 4));
        in_vain = run.committed() > committed ? 0 : in_vain + 1;
        committed = run.committed();
      }
      run.finish();
      EXPECT_THAT(run.verdict(undisturbed.sample()), IsEmpty());
      EXPECT_THAT(run.alarms(), Each(Not(HasSubstr("disagrees"))));
      if (HasFailure()) return;
    }
  }

  void kill_daemon(KilledRun& run, milliseconds most) {
    const bool at_launch = chance(4);
    run.run_daemon_for(at_launch ? KilledRun::From::launch : KilledRun::From::work,
                       up_to(at_launch ? milliseconds(200) : most));
  }

  void kill_twin(KilledRun& run, milliseconds most) {
    run.go_on();
    std::this_thread::sleep_for(up_to(most));
    run.rig().kill_twin();
    std::this_thread::sleep_for(up_to(milliseconds(100)));
    run.note_kill();
    run.rig().start_twin();
  }

  void kill_both(KilledRun& run, milliseconds most) {
    run.go_on();
    std::this_thread::sleep_for(up_to(most));
    const bool daemon_first = chance(2);
    if (daemon_first) run.rig().kill_daemon();
    run.rig().kill_twin();
    if (!daemon_first) run.rig().kill_daemon();
    run.note_kill();
    run.rig().start_twin();
  }

  bool chance(int one_in) { return std::uniform_int_distribution<int>(1, one_in)(random_) == 1; }

  microseconds up_to(microseconds most) {
    return microseconds(std::uniform_int_distribution<std::int64_t>(0, most.count())(random_));
  }

 private:
  const unsigned seed_ =
      static_cast<unsigned>(setting("BIOTOMY_KILL_SEED", static_cast<int>(std::random_device()())));
  std::mt19937 random_{seed_};
};

TEST_F(RandomKills, OfTheDaemonLeaveTheStackOfAnUndisturbedRun) {
  kill_over_and_over(40, [this](KilledRun& run, milliseconds most) { kill_daemon(run, most); });
}

TEST_F(RandomKills, OfTheControllerLeaveTheStackOfAnUndisturbedRun) {
  kill_over_and_over(10, [this](KilledRun& run, milliseconds most) { kill_twin(run, most); });
}

TEST_F(RandomKills, OfBothAtOnceLeaveTheStackOfAnUndisturbedRun) {
  kill_over_and_over(10, [this](KilledRun& run, milliseconds most) { kill_both(run, most); });
}

}  // namespace
}  // namespace biotomy::tests
