// On the kernel: one job, during which its lines are disturbed, its camera is unplugged and another
// process is in its way. After each test the job goes on, in the last one to its end.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <future>
#include <iostream>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "acquisition/job/job_states.hpp"
#include "tests/faults/status_watch.hpp"
#include "tests/firmware_bridge/thrown_message.hpp"
#include "tests/kernel/gpio_other_process.hpp"
#include "tests/kernel/kernel_plan.hpp"
#include "tests/kernel/kernel_rig.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// Of the command line.
fs::path folder;
int layers = 0;

constexpr int kMostDisturbances = 60;

/// In which a job that goes on by itself can be disturbed; each is left by an alarm.
std::set<std::string> states_on_the_way() {
  using acquisition::JobState;
  std::set<std::string> states;
  for (const acquisition::Transition& transition : acquisition::transitions()) {
    if (transition.event == acquisition::JobEvent::alarm) states.insert(to_string(transition.from));
  }
  // These take an operator or a warm block. The last comes once only, when all layers are stored.
  for (const char* other :
       {"idle", "faulted", "resetting", "pausing", "paused", "aborting", "aborted", "withdrawing",
        "held", "conditioning", "done", "finishing"}) {
    states.erase(other);
  }
  return states;
}

/// Whether all of these come by once only, as a job is begun or taken up again: not in each layer.
bool are_of_the_beginning(const std::set<std::string>& states) {
  static const std::set<std::string> beginning = {"preflight", "recovering", "homing"};
  return std::includes(beginning.begin(), beginning.end(), states.begin(), states.end());
}

class Disturbance : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    fs::create_directories(folder);
    RigPlan plan = kernel_plan(layers);
    plan.tick_ms = 80;  // a step takes a tick at least: long enough to be seen and disturbed
    rig_ = std::make_unique<KernelRig>(folder, plan);
    rig_->start_daemon();
    watch_ = std::make_unique<StatusWatch>(rig_->url());
    rig_->person().go_on();
  }
  static void TearDownTestSuite() {
    watch_.reset();
    rig_.reset();
  }

  static KernelRig& rig() { return *rig_; }
  static StatusWatch& watch() { return *watch_; }

  static void await_turning_wheel() {
    watch().await([](const nlohmann::json& status) {
      return status.at("state") == "grinding" && status.at("stage").at("spindle").at("rpm") > 0;
    });
  }

  static nlohmann::json await_standing_wheel() {
    watch().await_state("faulted");
    return watch().await([](const nlohmann::json& status) {
      return status.at("stage").at("spindle").at("rpm") == 0;
    });
  }

  /// As an operator would, to the next state with something to do.
  static void go_on() { rig().person().go_on(); }

  static std::unique_ptr<KernelRig> rig_;
  static std::unique_ptr<StatusWatch> watch_;
};

std::unique_ptr<KernelRig> Disturbance::rig_;
std::unique_ptr<StatusWatch> Disturbance::watch_;

TEST_F(Disturbance, ByAnEstopThatBouncesStopsTheWheel) {
  await_turning_wheel();
  {
    RigWires::Held wires(rig().wires());
    for (int i = 0; i < 10; ++i) {
      wires.pull(RigWires::estop, true);
      wires.pull(RigWires::estop, false);
    }
    EXPECT_THAT(told(await_standing_wheel()), HasSubstr("e-stop"));
  }
  go_on();
}

TEST_F(Disturbance, ByTheRigsOwnEstopStopsTheWheel) {
  await_turning_wheel();
  rig().bench().set_input(bridge::RigInput::estop, true);
  EXPECT_THAT(told(await_standing_wheel()), HasSubstr("e-stop"));
  rig().bench().set_input(bridge::RigInput::estop, false);
  go_on();
}

TEST_F(Disturbance, ByTheDoorStopsEveryState) {
  std::set<std::string> left = states_on_the_way();
  std::future<void> at_work = std::async(std::launch::async, [] {});
  for (int i = 0; i < kMostDisturbances && !left.empty(); ++i) {
    // One that was too short to be seen comes again with the next layer, or only when the job is
    // begun anew: then any state will do, so that the job's layers are not used up.
    const bool must_begin_anew = are_of_the_beginning(left);
    const std::int64_t enough = watch().look().at("committed").get<std::int64_t>() + 1;
    std::string state = watch()
                            .await([&](const nlohmann::json& status) {
                              return left.contains(status.at("state")) ||
                                     status.at("committed") >= enough ||
                                     (must_begin_anew && status.at("state") == "grinding");
                            })
                            .at("state");
    {
      RigWires::Held wires(rig().wires());
      wires.pull(RigWires::door, true);
      const nlohmann::json stopped = watch().await_state("faulted");
      EXPECT_THAT(told(stopped), HasSubstr("door")) << "in state " << state;
      // That in which the daemon saw it may be the next one.
      state = stopped.at("alarm").at("state");
      wires.pull(RigWires::door, false);
    }
    std::cout << "door opened while " << state << ", after " << enough - 1 << " layers"
              << std::endl;
    left.erase(state);
    at_work.get();
    // The first states of a job that goes on are over before the operator has seen it go.
    at_work = std::async(std::launch::async, [] { go_on(); });
  }
  at_work.get();
  EXPECT_THAT(left, IsEmpty());
}

TEST_F(Disturbance, ByAStormOfEdgesStopsTheJobOnce) {
  await_turning_wheel();
  {
    RigWires::Held wires(rig().wires());
    const auto end = steady_clock::now() + seconds(2);
    int edges = 0;
    for (; steady_clock::now() < end; edges += 2) {
      wires.pull(RigWires::door, true);
      wires.pull(RigWires::door, false);
    }
    EXPECT_GT(edges, 1000);
    EXPECT_THAT(told(await_standing_wheel()), HasSubstr("door"));
  }
  go_on();
  const std::int64_t committed = watch().look().at("committed");
  watch().await_committed(committed + 1);
}

TEST_F(Disturbance, ByACameraThatIsUnpluggedStopsTheJobUntilItIsBack) {
  watch().await_state("lighting");
  rig().unplug_camera();
  const nlohmann::json stopped = watch().await_stop();
  EXPECT_THAT(told(stopped), HasSubstr("camera"));
  rig().plug_in_camera();
  go_on();
  watch().await_committed(stopped.at("committed").get<std::int64_t>() + 1);
}

TEST_F(Disturbance, ByAProcessThatHoldsALineKeepsTheDaemonFromStarting) {
  watch_.reset();
  EXPECT_EQ(rig().end_daemon().exit_code, 0);
  {
    const GpioOtherProcess other(
        GpioOtherProcess::holds(rig().chip().device(), RigWires::estop, "somebody-else"));
    EXPECT_THAT(bridge::testing::thrown_message<std::runtime_error>([] { rig().start_daemon(); }),
                AllOf(HasSubstr("ESTOP"), HasSubstr("somebody-else")));
  }
  rig().start_daemon();
  watch_ = std::make_unique<StatusWatch>(rig().url());
  go_on();
}

/// Last: gtest runs them in this order.
TEST_F(Disturbance, ByTheDoorAtTheEndLeavesAJobThatIsDone) {
  watch().await_state("finishing");
  rig().bench().set_input(bridge::RigInput::door, true);
  std::string state;
  while (state != "done" && state != "faulted") state = watch().look().at("state");
  rig().bench().set_input(bridge::RigInput::door, false);
  const auto deadline = steady_clock::now() + seconds(60);
  while (state != "done" && steady_clock::now() < deadline) {
    go_on();
    state = watch().look().at("state");
  }
  EXPECT_EQ(state, "done");
  EXPECT_EQ(rig().end_daemon().exit_code, 0);
}

}  // namespace
}  // namespace biotomy::tests

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  if (argc != 3) {
    std::cerr << "usage: kernel_disturbance_tests FOLDER LAYERS\n";
    return 2;
  }
  biotomy::tests::folder = argv[1];
  biotomy::tests::layers = std::atoi(argv[2]);
  return RUN_ALL_TESTS();
}
