// The e-stop is pressed and the door opened in every state of a job.
#include <algorithm>
#include <chrono>
#include <future>
#include <ostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/faults/device_run.hpp"
#include "tests/faults/recovery_table.hpp"
#include "tests/faults/run_journal.hpp"
#include "tests/faults/wheel_stop.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::IsEmpty;

struct Input {
  const char* name;
  bridge::RigInput input;
  const char* told;
};

void PrintTo(const Input& input, std::ostream* out) {
  *out << input.name;
}

constexpr int kTries = 6;

class InputAtEveryState : public testing::TestWithParam<Input> {
 protected:
  /// A layer's short steps last as long as a tick: one of 20 ms leaves time to see them.
  static RigPlan plan() {
    RigPlan plan = device_plan(40);
    plan.tick_ms = 20;
    return plan;
  }

  /// Lets the job come to a state and disturbs it there; false when it had left it by then.
  bool disturb(DeviceRun& run, const std::string& state) {
    const bool before_the_layers = state == "preflight" || state == "recovering" ||
                                   state == "homing" || state == "conditioning";
    if (before_the_layers) {
      run.rig().rig("pause");
      run.watch().await_state("paused");
    }
    std::future<void> operator_at_work = std::async(std::launch::async, [&] {
      if (state == "pausing") {
        run.rig().rig("pause");
      } else {
        run.job().go_on();
      }
    });
    run.watch().await_state(state);
    const std::string began = now_utc();
    run.bench().set_input(GetParam().input, true);
    const nlohmann::json stopped = run.watch().await([](const nlohmann::json& status) {
      return status.at("state") == "faulted" || status.at("state") == "paused";
    });
    const std::string alarm = told(stopped);
    const bool there = stopped.at("state") == "faulted" && last_alarm(run, alarm).state == state;
    const std::string mended = now_utc();
    run.bench().set_input(GetParam().input, false);
    operator_at_work.get();
    if (!there) return false;
    EXPECT_THAT(alarm, HasSubstr(GetParam().told));
    const milliseconds took = state == "finishing" ? milliseconds(0) : run.recover(stopped);
    if (state == "grinding") {
      note_recovery({.fault = std::string(GetParam().name) + " while grinding",
                     .told = alarm,
                     .to_stop = wheel_told_to_stop(run.rig().witness(), began, mended,
                                                   run.rig().plan().time_scale),
                     .to_layer = took});
    }
    return true;
  }

  /// As the journal has it, once the daemon has written it down.
  static RunJournal::Alarm last_alarm(DeviceRun& run, const std::string& cause) {
    for (int look = 0; look < 200; ++look) {
      const RunJournal journal = read_run_journal(run.rig().sample() / "journal.sqlite");
      if (!journal.alarms.empty() && journal.alarms.back().cause == cause &&
          journal.alarms.size() > seen_) {
        seen_ = journal.alarms.size();
        return journal.alarms.back();
      }
      std::this_thread::sleep_for(milliseconds(5));
    }
    throw std::runtime_error("the alarm is not in the journal: " + cause);
  }

  static inline std::size_t seen_ = 0;
};

TEST_P(InputAtEveryState, StopsTheRunAndLeavesOneThatGoesOnToItsEnd) {
  seen_ = 0;
  DeviceRun run(plan());
  for (const std::string state : {"preflight", "recovering", "homing", "conditioning", "grinding",
                                  "retracting", "clearing", "settling", "lighting", "focusing",
                                  "capturing", "assessing", "storing", "pausing", "finishing"}) {
    SCOPED_TRACE(state);
    bool done = false;
    for (int i = 0; i < kTries && !done; ++i) done = disturb(run, state);
    EXPECT_TRUE(done) << "in " << kTries << " tries it was gone before it was disturbed";
  }
  run.job().finish();
  EXPECT_THAT(run.job().verdict(undisturbed_device_sample()), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(By, InputAtEveryState,
                         testing::Values(Input{"EStop", bridge::RigInput::estop,
                                               "the e-stop is pressed"},
                                         Input{"Door", bridge::RigInput::door, "the door is open"}),
                         [](const auto& input) { return std::string(input.param.name); });

}  // namespace
}  // namespace biotomy::tests
