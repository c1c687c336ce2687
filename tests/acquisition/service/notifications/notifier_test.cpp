#include "acquisition/service/notifications/notifier.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/acquisition/service/notifications/fake_channel.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using nlohmann::json;

struct NotifierTest : testing::Test {
  TemporaryFolder folder;
  std::shared_ptr<ChannelLog> log = std::make_shared<ChannelLog>();
  NotifierSettings settings;

  NotifierTest() { settings.queue = folder / "notifications"; }

  std::unique_ptr<Notifier> notifier() {
    std::vector<std::unique_ptr<Channel>> channels;
    channels.push_back(std::make_unique<FakeChannel>(log));
    return std::make_unique<Notifier>(settings, std::move(channels));
  }
  static Notice fault(const std::string& cause) {
    Notice notice;
    notice.kind = NoticeKind::fault;
    notice.text = cause;
    notice.job = "knee-042";
    notice.layer = 41;
    return notice;
  }
};

TEST_F(NotifierTest, DeliversWhatItIsTold) {
  const auto teller = notifier();
  teller->tell(fault("the door is \"open\""));
  ASSERT_TRUE(log->await_delivered(1));
  const json message = json::parse(log->delivered[0]);
  EXPECT_EQ(message.at("kind"), "fault");
  EXPECT_EQ(message.at("over"), false);
  EXPECT_EQ(message.at("text"), "the door is \"open\"");
  EXPECT_EQ(message.at("layer"), 41);
  EXPECT_EQ(message.at("count"), 1);
  EXPECT_EQ(message.at("id").get<std::string>().size(), 32U);
}

TEST_F(NotifierTest, FoldsRepeatedAlarmsUntilTheWindowEnds) {
  settings.fold_window = std::chrono::milliseconds(300);
  const auto teller = notifier();
  for (int i = 0; i < 20; ++i) teller->tell(fault("the link is lost"));
  ASSERT_TRUE(log->await_delivered(2));
  EXPECT_EQ(json::parse(log->delivered[1]).at("count"), 19);
}

TEST_F(NotifierTest, TellsInTheEndWhatItHadOnlyCounted) {
  {
    const auto teller = notifier();
    teller->tell(fault("the link is lost"));
    teller->tell(fault("the link is lost"));
  }
  const auto next = notifier();
  EXPECT_TRUE(log->await_delivered(2));
}

TEST_F(NotifierTest, RemembersThatTheRigWorked) {
  {
    const auto teller = notifier();
    EXPECT_FALSE(teller->interrupted());
    teller->work("the job knee-042");
  }  // ends without coming to rest
  {
    const auto teller = notifier();
    EXPECT_EQ(teller->interrupted(), "the job knee-042");
    teller->work("the job knee-042");
    teller->work("");
  }
  EXPECT_FALSE(notifier()->interrupted());
}

TEST_F(NotifierTest, TellsOfAStartThatFailsAgainOnlyWhenItFailsOtherwiseOrOneDidNotFail) {
  for (const char* why : {"no camera", "no camera", "no lines"}) {
    notifier()->tell_of_failed_start(fault(why));
  }
  {
    const auto teller = notifier();
    ASSERT_TRUE(log->await_delivered(2));
    teller->work("");  // a daemon that looks at the rig
  }
  const auto teller = notifier();
  teller->tell_of_failed_start(fault("no lines"));
  ASSERT_TRUE(log->await_delivered(3));
  const auto text = [&](std::size_t message) {
    return json::parse(log->delivered[message]).at("text").get<std::string>();
  };
  EXPECT_EQ(text(0), "no camera");
  EXPECT_EQ(text(1), "no lines");
  EXPECT_EQ(text(2), "no lines");
}

}  // namespace
}  // namespace biotomy::tests
