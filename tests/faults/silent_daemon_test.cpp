#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/faults/device_run.hpp"
#include "tests/faults/recovery_table.hpp"
#include "tests/faults/wheel_stop.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr milliseconds kWatchdog(400);
constexpr milliseconds kTolerance(400);  // of a twin that waits for a processor

TEST(SilentDaemon, IsStoppedForByTheControllerWithinItsTimeOut) {
  RigPlan plan = device_plan(3);
  plan.time_scale = 5;  // a pass lasts longer than the controller waits
  plan.twin_stage_settings = "watchdog_timeout = " + std::to_string(kWatchdog.count()) + "\n";
  DeviceRun run(plan);
  run.watch().await([](const nlohmann::json& status) {
    return status.at("committed") == 1 && status.at("state") == "grinding" &&
           status.at("stage").at("spindle").at("rpm") > 1000;
  });
  const std::string began = now_utc();
  run.rig().send_daemon(SIGSTOP);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (run.rig().witnessed("spindle_stopped").empty() ||
         run.rig().witnessed("spindle_stopped").back().at("time") < began) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "the wheel turns on";
    std::this_thread::sleep_for(milliseconds(10));
  }
  const auto to_stop = wheel_told_to_stop(run.rig().witness(), began, now_utc(), plan.time_scale);
  run.rig().send_daemon(SIGCONT);
  ASSERT_TRUE(to_stop);
  EXPECT_LE(*to_stop, kWatchdog + kTolerance);
  EXPECT_GE(*to_stop, kWatchdog / 2);

  const nlohmann::json stopped = run.watch().await_stop();
  EXPECT_EQ(stopped.at("state"), "faulted");
  EXPECT_THAT(told(stopped), HasSubstr("watchdog"));
  note_recovery({.fault = "daemon stands still",
                 .told = told(stopped),
                 .to_stop = to_stop,
                 .to_layer = run.recover(stopped)});
  run.job().finish();
  EXPECT_THAT(run.job().verdict(undisturbed_device_sample()), IsEmpty());
}

}  // namespace
}  // namespace biotomy::tests
