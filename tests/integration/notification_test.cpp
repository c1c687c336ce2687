// Messages of the real daemon, over a real web server and a real program.
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/file_content.hpp"
#include "tests/integration/hook_server.hpp"
#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using testing::HasSubstr;

RigPlan plan_with(const std::string& notify, int layers = 3) {
  RigPlan plan;
  plan.layers = layers;
  plan.width = 64;
  plan.height = 48;
  plan.daemon_settings = notify;
  return plan;
}

std::string webhook(const HookServer& hook) {
  return "[notify]\nwebhook = \"" + hook.url() +
         "\"\nfirst_retry_ms = 20\nlongest_retry_ms = 100\n";
}

TEST(Notifications, TellTheEndOfAJobByCommandAndByWebhook) {
  HookServer hook;
  const TemporaryFolder folder;
  const std::filesystem::path told = folder / "told";
  SimulatedRig rig(plan_with(webhook(hook) +
                             "command = [\"/bin/sh\", \"-c\", \"cat > $0.part; mv $0.part $0\", "
                             "\"" +
                             told.string() + "\"]\n"));
  rig.start_daemon();
  ASSERT_EQ(rig.rig("start").exit_code, 0);
  ASSERT_EQ(rig.rig("watch", seconds(120)).exit_code, 0);
  const json message = hook.await_message("done");
  ASSERT_FALSE(message.is_null());
  EXPECT_EQ(message.at("committed"), 3);
  EXPECT_EQ(message.at("job"), "sample");
  const auto limit = std::chrono::steady_clock::now() + seconds(60);
  while (!std::filesystem::exists(told)) ASSERT_LT(std::chrono::steady_clock::now(), limit);
  EXPECT_EQ(json::parse(std::ifstream(told)), message);
  EXPECT_EQ(rig.end_daemon().exit_code, 0);
  EXPECT_EQ(hook.messages().size(), 1U);
}

TEST(Notifications, TellAFaultAndTheEndOfIt) {
  HookServer hook;
  SimulatedRig rig(plan_with("[safety]\ngrind_limit_ms = 1\n" + webhook(hook)));
  rig.start_daemon();
  ASSERT_EQ(rig.rig("start").exit_code, 0);
  const Outcome watched = rig.rig("watch", seconds(120));
  EXPECT_EQ(watched.exit_code, 1);
  EXPECT_THAT(watched.errors, HasSubstr("the rig is stopped: grinding took longer than 1 ms"));
  const json message = hook.await_message("fault");
  ASSERT_FALSE(message.is_null());
  EXPECT_THAT(message.at("text").get<std::string>(), HasSubstr("grinding took longer than 1 ms"));
  const auto limit = std::chrono::steady_clock::now() + seconds(60);
  while (rig.rig("acknowledge").exit_code != 0) {  // it is still being parked
    ASSERT_LT(std::chrono::steady_clock::now(), limit);
  }
  EXPECT_FALSE(hook.await_message("fault", true).is_null());
}

TEST(Notifications, SurviveADaemonThatIsKilledBeforeTheyAreDelivered) {
  HookServer hook;
  hook.refuse(true);
  SimulatedRig rig(plan_with(webhook(hook), 1000));
  rig.start_daemon();
  ASSERT_EQ(rig.rig("start").exit_code, 0);
  const auto limit = std::chrono::steady_clock::now() + seconds(60);
  while (rig.status().at("committed") < 1) {
    ASSERT_LT(std::chrono::steady_clock::now(), limit) << rig.status().dump(1);
  }
  rig.kill_daemon();
  rig.start_daemon();  // finds that the one before it ended at work
  ASSERT_TRUE(hook.await_attempts(3));
  rig.kill_daemon();
  EXPECT_TRUE(hook.messages().empty());
  hook.refuse(false);
  rig.start_daemon();
  const json message = hook.await_message("interrupted");
  ASSERT_FALSE(message.is_null());
  EXPECT_THAT(message.at("text").get<std::string>(), HasSubstr("the job sample, since "));
}

/// In rig.toml of a daemon that does not run.
void unplug_camera(const SimulatedRig& rig) {
  const std::filesystem::path file = rig.folder() / "rig.toml";
  std::string text = content_of(file);
  const std::string socket = "[camera]\nbackend = \"socket\"";
  const std::size_t at = text.find(socket);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, socket.size(), "[camera]\nbackend = \"libcamera\"\ncamera = \"gone\"");
  std::ofstream(file) << text;
}

std::vector<json> waiting_messages(const SimulatedRig& rig) {
  std::vector<json> messages;
  const auto queue = rig.folder() / "notifications/webhook";
  for (const auto& entry : std::filesystem::directory_iterator(queue)) {
    messages.push_back(json::parse(content_of(entry.path())));
  }
  return messages;
}

TEST(Notifications, TellOnceThatAnInterruptedRunWaitsForADaemonThatCannotStart) {
  HookServer hook;
  hook.refuse(true);
  SimulatedRig rig(plan_with("device_wait_ms = 0\n" + webhook(hook), 1000));
  rig.start_daemon();
  ASSERT_EQ(rig.rig("start").exit_code, 0);
  const auto limit = std::chrono::steady_clock::now() + seconds(60);
  while (rig.status().at("committed") < 1) {
    ASSERT_LT(std::chrono::steady_clock::now(), limit) << rig.status().dump(1);
  }
  rig.kill_daemon();
  unplug_camera(rig);
  for (int start = 0; start < 2; ++start) {
    rig.launch_daemon();
    EXPECT_EQ(rig.await_daemon_end(seconds(20)).exit_code, 1);
  }
  const std::vector<json> waiting = waiting_messages(rig);
  ASSERT_EQ(waiting.size(), 1U);
  EXPECT_EQ(waiting.front().at("kind"), "interrupted");
  EXPECT_THAT(waiting.front().at("text").get<std::string>(),
              testing::AllOf(HasSubstr("the job sample, since "),
                             HasSubstr("and cannot start again: camera")));
}

TEST(Notifications, DoNotTellOfAStartThatFailsWhileNoRunWasInterrupted) {
  HookServer hook;
  hook.refuse(true);
  SimulatedRig rig(plan_with("device_wait_ms = 0\n" + webhook(hook)));
  unplug_camera(rig);
  rig.launch_daemon();
  EXPECT_EQ(rig.await_daemon_end(seconds(20)).exit_code, 1);
  EXPECT_TRUE(waiting_messages(rig).empty());
}

TEST(Notifications, DoNotCallARunInterruptedThatWasEndedInOrder) {
  HookServer hook;
  SimulatedRig rig(plan_with(webhook(hook), 1000));
  rig.start_daemon();
  ASSERT_EQ(rig.rig("start").exit_code, 0);
  EXPECT_EQ(rig.end_daemon().exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(rig.folder() / "notifications/rig-at-work"));
  EXPECT_TRUE(hook.messages().empty());
}

TEST(Notifications, CanBeTried) {
  HookServer hook;
  SimulatedRig rig(plan_with(webhook(hook) +
                             "command = [\"/bin/sh\", \"-c\", \"echo no paper >&2; exit 3\"]\n"));
  const Outcome outcome = run(
      {BIOTOMY_DAEMON, "--test-notification", "--config", rig.folder() / "rig.toml"}, rig.folder());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("webhook: delivered"));
  EXPECT_THAT(outcome.errors, HasSubstr("command: /bin/sh failed, exit code 3: no paper"));
  EXPECT_FALSE(hook.await_message("test").is_null());
}

TEST(Notifications, SayWhenThereIsNobodyToTell) {
  SimulatedRig rig(plan_with(""));
  const Outcome outcome = run(
      {BIOTOMY_DAEMON, "--test-notification", "--config", rig.folder() / "rig.toml"}, rig.folder());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("set notify.command or notify.webhook"));
}

}  // namespace
}  // namespace biotomy::tests
