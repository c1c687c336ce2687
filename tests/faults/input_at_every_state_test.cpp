// The e-stop is pressed and the door opened in every state of a job.
#include <algorithm>
#include <chrono>
#include <deque>
#include <future>
#include <initializer_list>
#include <optional>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "acquisition/job/job_states.hpp"
#include "tests/faults/device_run.hpp"
#include "tests/faults/recovery_table.hpp"
#include "tests/faults/wheel_stop.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
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

constexpr int kMostDisturbances = 64;
constexpr milliseconds kSurelyGoneBy(1000);
constexpr const char* kWarmBlock = "cooler";

/// Every step of the host alone lasts a tick at least: long enough to be seen and disturbed.
RigPlan slow_plan() {
  RigPlan plan = device_plan(32);
  plan.tick_ms = 40;
  plan.daemon_settings += "[safety]\ntemperature_delay_ms = 50\ntemperature_resumes = true\n";
  return plan;
}

bool is_one_of(const std::string& state, std::initializer_list<const char*> states) {
  return std::find(states.begin(), states.end(), state) != states.end();
}

bool at_rest(const nlohmann::json& status) {
  return is_one_of(status.at("state"), {"faulted", "paused", "aborted", "done"});
}

/// Before the first layer, not with each.
bool comes_once(const std::string& state) {
  return is_one_of(state, {"resetting", "preflight", "recovering", "homing", "conditioning"});
}

/// In which something moves or is about to. `finishing` is last: it comes when all layers are
/// stored.
std::deque<std::string> states_with_alarms() {
  using acquisition::JobState;
  std::deque<std::string> states;
  for (const acquisition::Transition& transition : acquisition::transitions()) {
    const bool is_alarm = transition.event == acquisition::JobEvent::alarm;
    if (is_alarm && transition.from != JobState::finishing) {
      states.emplace_back(to_string(transition.from));
    }
  }
  states.emplace_back(to_string(JobState::finishing));
  return states;
}

class InputAtEveryState : public testing::TestWithParam<Input> {
 protected:
  /// Lets the job come to a state and disturbs it there. Returns the state in which the daemon saw
  /// it, which may be the next one; empty when the job had come to rest by then, or when the state
  /// went by unseen. In any case it leaves a job that goes on.
  std::string disturb(const std::string& state) {
    bring_near(state);
    std::future<void> operator_at_work =
        std::async(std::launch::async, [this, state] { lead_to(state); });
    const bool came = await(state, operator_at_work);
    const std::string began = now_utc();
    if (came) run_.bench().set_input(GetParam().input, true);
    const nlohmann::json stopped = came ? await_rest() : run_.watch().look();
    const std::string mended = now_utc();
    run_.bench().set_input(GetParam().input, false);
    operator_at_work.get();
    if (is_one_of(state, {"withdrawing", "held"})) run_.bench().end_fault(kWarmBlock);
    if (!came || stopped.at("state") != "faulted") return "";
    EXPECT_THAT(told(stopped), HasSubstr(GetParam().told));
    const std::string found_in = stopped.at("alarm").at("state");
    if (found_in == "grinding") {
      note_recovery({.fault = std::string(GetParam().name) + " while grinding",
                     .told = told(stopped),
                     .to_stop = wheel_told_to_stop(run_.rig().witness(), began, mended,
                                                   run_.rig().plan().time_scale),
                     .to_layer = run_.recover(stopped)});
    }
    return found_in;
  }

  DeviceRun run_{slow_plan()};

 private:
  void bring_near(const std::string& state) {
    const std::string now = run_.watch().look().at("state");
    const bool stands_still = now == "faulted" || now == "paused";
    if (now == "done" || now == "aborted") {
      run_.rig().rig("start");
    } else if (is_one_of(state, {"pausing", "aborting", "withdrawing", "held"})) {
      run_.job().go_on();
      run_.watch().await_state("grinding");
    } else if (state == "resetting" && now != "faulted") {
      if (stands_still) {  // where the input stops nothing
        run_.job().go_on();
        run_.watch().await_state("grinding");
      }
      run_.bench().set_input(GetParam().input, true);
      await_rest();
      run_.bench().set_input(GetParam().input, false);
    } else if (comes_once(state) && !stands_still) {
      run_.rig().rig("pause");
      await_rest();
    }
  }

  void lead_to(const std::string& state) {
    if (state == "pausing") {
      run_.rig().rig("pause");
    } else if (state == "aborting") {
      run_.rig().rig("abort");
    } else if (state == "resetting") {
      run_.rig().rig("acknowledge");
    } else if (is_one_of(state, {"withdrawing", "held"})) {
      run_.bench().begin_fault(kWarmBlock, "fault = \"cooler_fails\"\ntime_constant = 20");
    } else {
      run_.job().go_on();
    }
  }

  /// Waits until the job is there, or done. False when it went by: on a machine that was busy for a
  /// moment a state is not seen, and what the operator did leads to no other.
  bool await(const std::string& state, const std::future<void>& operator_at_work) {
    std::optional<steady_clock::time_point> gone_by_since;
    bool is_there = false;
    run_.watch().await([&](const nlohmann::json& status) {
      const std::string now = status.at("state");
      const bool turns = state != "grinding" || status.at("stage").at("spindle").at("rpm") > 0;
      is_there = now == "done" || (now == state && turns);
      const bool is_led = operator_at_work.wait_for(milliseconds(0)) != std::future_status::ready;
      const bool gone_by = !is_led && (at_rest(status) || (comes_once(state) && !comes_once(now)));
      if (!gone_by) gone_by_since.reset();
      if (gone_by && !gone_by_since) gone_by_since = steady_clock::now();
      return is_there || (gone_by && steady_clock::now() - *gone_by_since > kSurelyGoneBy);
    });
    return is_there;
  }

  nlohmann::json await_rest() { return run_.watch().await(at_rest); }
};

TEST_P(InputAtEveryState, StopsTheRunAndLeavesOneThatGoesOnToItsEnd) {
  std::deque<std::string> left = states_with_alarms();
  for (int i = 0; i < kMostDisturbances && !left.empty(); ++i) {
    SCOPED_TRACE(left.front());
    const auto came = std::find(left.begin(), left.end(), disturb(left.front()));
    if (came != left.end()) left.erase(came);
  }
  EXPECT_THAT(left, IsEmpty());
  run_.job().finish();
  EXPECT_THAT(run_.job().verdict(undisturbed_device_sample()), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(By, InputAtEveryState,
                         testing::Values(Input{"EStop", bridge::RigInput::estop, "e-stop"},
                                         Input{"Door", bridge::RigInput::door, "door"}),
                         [](const auto& input) { return std::string(input.param.name); });

}  // namespace
}  // namespace biotomy::tests
