#include "acquisition/service/notifications/command_channel.hpp"

#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "acquisition/service/notifications/notice.hpp"
#include "tests/file_content.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr milliseconds kTime{60000};

std::string message() {
  Notice notice;
  notice.kind = NoticeKind::fault;
  notice.text = "the door is open; $(rm -rf /) `x`";
  notice.job = "knee 042";
  return notice_json(notice, "id");
}

struct CommandChannelTest : testing::Test {
  TemporaryFolder folder;
  std::filesystem::path out = folder / "out";

  /// A shell script, with the output file as $0.
  CommandChannel script(const std::string& text) {
    return CommandChannel({"/bin/sh", "-c", text, out});
  }
  static auto delivering(CommandChannel& channel, milliseconds time = kTime,
                         std::stop_token stop = {}) {
    return [&channel, time, stop] { channel.deliver(message(), time, stop); };
  }
};

TEST_F(CommandChannelTest, GivesTheMessageOnStandardInput) {
  CommandChannel channel = script("cat > \"$0\"");
  channel.deliver(message(), kTime, {});
  EXPECT_EQ(content_of(out), message());
}

TEST_F(CommandChannelTest, TakesExitCode65ForARefusalOfTheMessage) {
  CommandChannel refusing = script("exit 65");
  EXPECT_THAT(delivering(refusing), testing::Throws<MessageRefused>());
  CommandChannel failing = script("exit 64");
  EXPECT_THAT(delivering(failing), testing::Not(testing::Throws<MessageRefused>()));
}

TEST_F(CommandChannelTest, GivesTheMessageInTheEnvironmentToo) {
  ::setenv("NOTIFY_SOCKET", "/nowhere", 1);
  CommandChannel channel = script(
      "echo \"$BIOTOMY_KIND|$BIOTOMY_OVER|$BIOTOMY_TEXT|$BIOTOMY_JOB|$NOTIFY_SOCKET|$HOME\" > "
      "\"$0\"");
  channel.deliver(message(), kTime, {});
  ::unsetenv("NOTIFY_SOCKET");
  const char* home = std::getenv("HOME");
  EXPECT_EQ(content_of(out), "fault|false|the door is open; $(rm -rf /) `x`|knee 042||" +
                                 std::string(home == nullptr ? "" : home) + "\n");
}

TEST_F(CommandChannelTest, HandsArgumentsOverWithoutAShell) {
  CommandChannel channel({"/bin/sh", "-c", "printf %s \"$1\" > \"$0\"", out, "a b; $(false) 'c'"});
  channel.deliver(message(), kTime, {});
  EXPECT_EQ(content_of(out), "a b; $(false) 'c'");
}

TEST_F(CommandChannelTest, DoesNotNeedToHaveItsMessageRead) {
  CommandChannel channel({"/bin/true"});
  EXPECT_NO_THROW(channel.deliver(message(), kTime, {}));
}

TEST_F(CommandChannelTest, SaysWhyItFailed) {
  CommandChannel failing = script("echo no paper >&2; exit 3");
  EXPECT_THAT(delivering(failing),
              ThrowsMessage<DeliveryError>(AllOf(HasSubstr("exit code 3"), HasSubstr("no paper"))));
  CommandChannel killed = script("kill -9 $$");
  EXPECT_THAT(delivering(killed), ThrowsMessage<DeliveryError>(HasSubstr("signal 9")));
  CommandChannel missing({"/nowhere/mail"});
  EXPECT_THAT(delivering(missing), ThrowsMessage<DeliveryError>(HasSubstr("/nowhere/mail")));
}

TEST_F(CommandChannelTest, EndsWhatTakesTooLongWithAllThatItStarted) {
  CommandChannel channel = script("sleep 1000 & echo $! > \"$0\"; wait");
  EXPECT_THAT(delivering(channel, milliseconds(300)),
              ThrowsMessage<DeliveryError>(HasSubstr("took longer than 300 ms")));
  const pid_t left = std::stoi("0" + content_of(out));
  if (left == 0) GTEST_SKIP() << "the machine was too busy to start the script in time";
  // Killed at once; whoever reaps orphans may take a moment more, so a zombie is gone, too.
  const auto limit = steady_clock::now() + std::chrono::seconds(30);
  const auto is_there = [left] {
    std::ifstream status("/proc/" + std::to_string(left) + "/stat");
    std::string number, name, state;
    return (status >> number >> name >> state) && state != "Z" && state != "X";
  };
  while (is_there() && steady_clock::now() < limit) std::this_thread::yield();
  EXPECT_FALSE(is_there());
}

TEST_F(CommandChannelTest, GivesUpWhenTheDaemonStops) {
  CommandChannel channel = script("sleep 1000");
  std::stop_source source;
  source.request_stop();
  EXPECT_THAT(delivering(channel, kTime, source.get_token()),
              ThrowsMessage<DeliveryError>(HasSubstr("was stopped")));
}

}  // namespace
}  // namespace biotomy::tests
