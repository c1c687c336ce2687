// The daemon as systemd and Prometheus see it.
#include <csignal>
#include <cstring>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/ptrace.h>
#include <sys/wait.h>

#include "tests/integration/simulated_rig.hpp"
#include "tests/notify_socket.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

RigPlan small_plan(int layers) {
  RigPlan plan;
  plan.layers = layers;
  plan.width = 64;
  plan.height = 48;
  return plan;
}

/// The thread of that name; 0 when there is none.
pid_t thread_named(pid_t process, const std::string& name) {
  const std::filesystem::path tasks = "/proc/" + std::to_string(process) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks)) {
    std::string found;
    std::ifstream(task.path() / "comm") >> found;
    if (found == name) return std::stoi(task.path().filename());
  }
  return 0;
}

TEST(Service, TellsSystemdThatItIsReadyWhatItDoesAndThatItStops) {
  const TemporaryFolder folder;
  NotifySocket systemd(folder / "notify", microseconds(15000000));
  SimulatedRig rig(small_plan(1000));
  rig.start_daemon();
  EXPECT_TRUE(systemd.await("READY=1", seconds(60)));
  EXPECT_TRUE(systemd.await("STATUS=faulted, 0 stored; waits for an operator", seconds(60)));
  EXPECT_TRUE(systemd.await("WATCHDOG=1", seconds(60)));
  ASSERT_EQ(rig.rig("start").exit_code, 0);
  EXPECT_TRUE(systemd.await(" of 1000, ", seconds(60)));
  EXPECT_EQ(rig.end_daemon().exit_code, 0);
  EXPECT_TRUE(systemd.await("STOPPING=1", seconds(60)));
  EXPECT_TRUE(systemd.await("EXTEND_TIMEOUT_USEC=", seconds(60)));
}

TEST(Service, BringsTheRigToRestWhenItsTerminalGoesAwayOrIsToldToQuit) {
  for (const int signal : {SIGHUP, SIGQUIT}) {
    SimulatedRig rig(small_plan(1000));
    rig.start_daemon();
    ASSERT_EQ(rig.rig("start").exit_code, 0);
    rig.send_daemon(signal);
    const Outcome end = rig.await_daemon_end(seconds(60));
    EXPECT_EQ(end.exit_code, 0) << strsignal(signal) << end.errors;
    EXPECT_THAT(end.errors, HasSubstr("is ending: brings the rig to rest"));
  }
}

TEST(Service, GoesOnWithoutItsTerminalWhenItWasStartedByNohup) {
  SimulatedRig rig(small_plan(3));
  rig.launch_daemon({"/usr/bin/nohup"});
  rig.await_daemon();
  ASSERT_EQ(rig.rig("start").exit_code, 0);
  rig.send_daemon(SIGHUP);
  EXPECT_EQ(rig.rig("watch", seconds(120)).exit_code, 0);
  EXPECT_EQ(rig.end_daemon().exit_code, 0);
}

RigPlan plan_without_camera() {
  RigPlan plan = small_plan(2);
  plan.daemon_camera = "backend = \"libcamera\"\ncamera = \"no-such-camera\"\n";
  return plan;
}

TEST(Service, WaitsForADeviceThatIsMissingUntilItIsToldToEnd) {
  const TemporaryFolder folder;
  NotifySocket systemd(folder / "notify");
  SimulatedRig rig(plan_without_camera());
  rig.launch_daemon();
  EXPECT_TRUE(systemd.await("STATUS=waits for a device: camera", seconds(60)));
  EXPECT_TRUE(systemd.await("EXTEND_TIMEOUT_USEC=", seconds(60), 1));  // of a second try
  EXPECT_EQ(systemd.count("READY=1"), 0U);
  const Outcome end = rig.end_daemon(seconds(20));
  EXPECT_EQ(end.exit_code, 0) << end.errors;
  const std::size_t told = end.errors.find("waits up to 120 s for a device: camera");
  EXPECT_NE(told, std::string::npos) << end.errors;
  EXPECT_EQ(end.errors.find("waits up to", told + 1), std::string::npos) << end.errors;
}

TEST(Service, EndsAtOnceForADeviceThatItIsNotToWaitFor) {
  RigPlan plan = plan_without_camera();
  plan.daemon_settings = "device_wait_ms = 0\n";
  SimulatedRig rig(plan);
  rig.launch_daemon();
  const Outcome end = rig.await_daemon_end(seconds(20));
  EXPECT_EQ(end.exit_code, 1);
  EXPECT_THAT(end.errors, HasSubstr("biotomyd: camera"));
}

TEST(Service, GivesNoSignOfLifeWhileItsControlThreadHangs) {
  const TemporaryFolder folder;
  NotifySocket systemd(folder / "notify", microseconds(15000000));
  SimulatedRig rig(small_plan(2));
  rig.start_daemon();
  ASSERT_TRUE(systemd.await("WATCHDOG=1", seconds(60)));

  const pid_t control = thread_named(rig.daemon_pid(), "control");
  ASSERT_NE(control, 0);
  if (ptrace(PTRACE_SEIZE, control, nullptr, nullptr) != 0) {
    GTEST_SKIP() << "this machine does not let a test stop a thread (ptrace)";
  }
  ASSERT_EQ(ptrace(PTRACE_INTERRUPT, control, nullptr, nullptr), 0);
  ASSERT_EQ(waitpid(control, nullptr, __WALL), control);
  // The last tick before it may still be told; then there must be silence, where a sign a second
  // was given before, while the rest of the daemon answers.
  EXPECT_FALSE(systemd.await("WATCHDOG=1", seconds(5), systemd.count("WATCHDOG=1") + 1));
  EXPECT_TRUE(httplib::Client(rig.url()).Get("/healthz"));

  ASSERT_EQ(ptrace(PTRACE_DETACH, control, nullptr, nullptr), 0);
  EXPECT_TRUE(systemd.await("WATCHDOG=1", seconds(60), systemd.count("WATCHDOG=1")));
}

/// Name and type of each metric in the table of the page.
std::map<std::string, std::string> documented_metrics() {
  std::map<std::string, std::string> metrics;
  std::ifstream page(BIOTOMY_METRICS_PAGE);
  const std::regex row(R"(\| `(biotomy_\w+)` \| (\w+) \|.*)");
  std::smatch match;
  for (std::string line; std::getline(page, line);) {
    if (std::regex_match(line, match, row)) metrics[match[1]] = match[2];
  }
  return metrics;
}

TEST(Service, ShowsPrometheusTheMetricsOfItsPageAndNoOthers) {
  RigPlan plan = small_plan(3);
  plan.daemon_settings = "[notify]\ncommand = [\"/bin/true\"]\n";
  SimulatedRig rig(plan);
  rig.start_daemon();
  ASSERT_EQ(rig.rig("start").exit_code, 0);
  ASSERT_EQ(rig.rig("watch", seconds(120)).exit_code, 0);
  const auto response = httplib::Client(rig.url()).Get("/metrics");
  ASSERT_TRUE(response);
  ASSERT_EQ(response->status, 200);

  std::map<std::string, std::string> shown;
  std::set<std::string> with_values;
  std::istringstream lines(response->body);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string hash, kind, name, type;
    if (line.starts_with("# TYPE ")) {
      words >> hash >> kind >> name >> type;
      shown[name] = type;
    } else if (!line.starts_with("#")) {
      name = line.substr(0, line.find_first_of("{ "));
      for (const char* part : {"_bucket", "_sum", "_count"}) {
        const std::string whole = name.substr(0, name.rfind(part));
        if (shown.contains(whole) && shown.at(whole) == "histogram") name = whole;
      }
      with_values.insert(name);
    }
  }
  EXPECT_EQ(shown, documented_metrics());
  for (const std::string& name : with_values) EXPECT_TRUE(shown.contains(name)) << name;
  EXPECT_THAT(response->body, HasSubstr("biotomy_job_layers_committed 3\n"));
  EXPECT_THAT(response->body, HasSubstr("biotomy_job_state{state=\"done\"} 1\n"));
  EXPECT_THAT(response->body,
              HasSubstr("biotomy_step_duration_seconds_count{step=\"storing\"} 3\n"));
  EXPECT_THAT(response->body, HasSubstr("biotomy_attempts_total{verdict=\"accepted\""));
  EXPECT_THAT(response->body, HasSubstr("biotomy_last_layer_quality{metric=\""));
}

}  // namespace
}  // namespace biotomy::tests
