#include <chrono>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

#include "tests/faults/faulty_link.hpp"
#include "tests/faults/run_judge.hpp"
#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kShareOfFaultyExchanges = 0.1;
constexpr milliseconds kLongestDelay(120);  // far beyond the response time-out
constexpr seconds kPatience(30);
constexpr seconds kLongestRun(1500);

int setting(const char* name, int fallback) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : fallback;
}

/// A whole run with a tenth of the exchanges between daemon and controller spoilt. The limits are
/// those of a patient operator: a bad line that is alive is no reason to stop.
class RunOverABadLine : public testing::TestWithParam<const char*> {
 protected:
  RigPlan plan() const {
    RigPlan plan{
        .width = 64,
        .height = 48,
        .layers = layers_,
        .time_scale = 400,
        .listen = GetParam() == std::string("tcp") ? "tcp://127.0.0.1:0" : "rtu://controller.line"};
    plan.twin_stage_settings = "watchdog_timeout = 20000\n";
    plan.daemon_stage_settings = "response_timeout_ms = 50\nbaud = 115200\n";
    plan.daemon_settings =
        "[safety]\nrequire_watchdog = false\nlink_lost_ms = 10000\nread_back_ms = 50\n";
    return plan;
  }

  /// From the daemon's start to the job's end. Throws std::runtime_error if it stops before.
  static void finish(SimulatedRig& rig) {
    rig.start_daemon();
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    for (;;) {
      const Outcome started = rig.rig("start");
      if (started.exit_code == 0) break;
      // A person does what the daemon says, too, when the line has lost just this message.
      const bool again = started.errors.find("try again") != std::string::npos;
      if (!again || std::chrono::steady_clock::now() > deadline) {
        throw std::runtime_error(started.errors);
      }
    }
    const Outcome watched = rig.rig("watch", kLongestRun);
    if (watched.exit_code != 0) throw std::runtime_error(watched.output + watched.errors);
  }

  const int layers_ = setting("BIOTOMY_LINK_LAYERS", 40);
  const int seed_ = setting("BIOTOMY_LINK_SEED", 20);
};

TEST_P(RunOverABadLine, LeavesTheStackOfAnUndisturbedRun) {
  std::cout << "BIOTOMY_LINK_LAYERS=" << layers_
            << " (the proof is of 500) BIOTOMY_LINK_SEED=" << seed_ << std::endl;
  SimulatedRig undisturbed(plan());
  finish(undisturbed);

  const TemporaryFolder folder;
  std::unique_ptr<FaultyLink> line;
  RigPlan disturbed = plan();
  disturbed.line_between = [&](const std::string& controller) {
    line =
        std::make_unique<FaultyLink>(controller, folder.path(),
                                     LinkFaultPlan::evenly(kShareOfFaultyExchanges, kLongestDelay,
                                                           static_cast<std::uint64_t>(seed_)));
    return line->endpoint();
  };
  SimulatedRig rig(disturbed);
  finish(rig);
  const LinkFaultCounts counts = line->counts();
  std::cout << counts.text() << std::endl;
  EXPECT_GT(counts.all_faults(), counts.exchanges / 15);
  for (const std::int64_t of_a_kind : counts.faults) EXPECT_GT(of_a_kind, 0);

  EXPECT_THAT(judge({.witness = rig.witness(),
                     .sample = rig.sample(),
                     .layers = disturbed.layers,
                     .first_face_um = disturbed.first_face_um,
                     .layer_thickness_um = disturbed.layer_thickness_um,
                     .kills = {}},
                    undisturbed.sample()),
              testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Over, RunOverABadLine, testing::Values("tcp", "rtu"),
                         [](const auto& line) { return std::string(line.param); });

}  // namespace
}  // namespace biotomy::tests
