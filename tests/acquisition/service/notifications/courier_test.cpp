#include "acquisition/service/notifications/courier.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/acquisition/service/notifications/fake_channel.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::milliseconds;
using testing::ElementsAre;

struct CourierTest : testing::Test {
  TemporaryFolder folder;
  std::shared_ptr<ChannelLog> log = std::make_shared<ChannelLog>();
  CourierSettings settings{.keep = 10,
                           .time_out = milliseconds(1000),
                           .first_retry = milliseconds(1),
                           .longest_retry = milliseconds(4)};

  std::unique_ptr<Courier> courier() {
    return std::make_unique<Courier>(std::make_unique<FakeChannel>(log), folder / "queue",
                                     settings);
  }
};

TEST_F(CourierTest, DeliversInOrder) {
  const auto messenger = courier();
  messenger->take("1");
  messenger->take("2");
  ASSERT_TRUE(log->await_delivered(2));
  EXPECT_THAT(log->delivered, ElementsAre("1", "2"));
}

TEST_F(CourierTest, TriesAgainUntilTheMessageIsDelivered) {
  log->failures_to_come = 7;
  const auto messenger = courier();
  messenger->take("1");
  messenger->take("2");
  ASSERT_TRUE(log->await_delivered(2));
  EXPECT_THAT(log->delivered, ElementsAre("1", "2"));
  EXPECT_EQ(log->attempts, 9);
  EXPECT_EQ(messenger->figures().failed_attempts, 7U);
}

TEST_F(CourierTest, LeavesToTheNextOneWhatItCouldNotDeliver) {
  settings.first_retry = settings.longest_retry = std::chrono::hours(1);
  log->failures_to_come = 1;
  {
    const auto messenger = courier();
    messenger->take("1");
    ASSERT_TRUE(log->await_attempts(1));
  }
  EXPECT_THAT(log->delivered, ElementsAre());
  const auto next = courier();
  ASSERT_TRUE(log->await_delivered(1));
  EXPECT_THAT(log->delivered, ElementsAre("1"));
}

TEST_F(CourierTest, TriesAtOnceWhenANewMessageComes) {
  settings.first_retry = settings.longest_retry = std::chrono::hours(1);
  log->failures_to_come = 1;
  const auto messenger = courier();
  messenger->take("1");
  ASSERT_TRUE(log->await_attempts(1));
  messenger->take("2");
  ASSERT_TRUE(log->await_delivered(2));
  EXPECT_THAT(log->delivered, ElementsAre("1", "2"));
}

TEST_F(CourierTest, LetsOthersPassAMessageThatIsRefused) {
  settings.first_retry = settings.longest_retry = std::chrono::hours(1);
  log->refused = "1";
  auto messenger = courier();
  messenger->take("1");
  messenger->take("2");
  ASSERT_TRUE(log->await_delivered(1));
  messenger->take("3");
  ASSERT_TRUE(log->await_delivered(2));
  messenger.reset();
  EXPECT_THAT(log->delivered, ElementsAre("2", "3"));
  EXPECT_EQ(courier()->figures().waiting, 1U);
}

TEST_F(CourierTest, TriesARefusedMessageAgainAfterAPause) {
  log->refused = "1";
  const auto messenger = courier();
  messenger->take("1");
  ASSERT_TRUE(log->await_attempts(3));
  {
    const std::scoped_lock lock(log->mutex);
    log->refused.clear();
  }
  ASSERT_TRUE(log->await_delivered(1));
}

TEST_F(CourierTest, EndsAtOnceWhenAnAttemptHangs) {
  log->hangs = true;
  {
    const auto messenger = courier();
    messenger->take("1");
    ASSERT_TRUE(log->await_attempts(1));
  }
  log->hangs = false;
  const auto next = courier();
  EXPECT_TRUE(log->await_delivered(1));
}

TEST_F(CourierTest, TakesMessagesWhileAnAttemptHangs) {
  log->hangs = true;
  const auto messenger = courier();
  messenger->take("1");
  ASSERT_TRUE(log->await_attempts(1));
  messenger->take("2");
  EXPECT_EQ(messenger->figures().waiting, 2U);
}

}  // namespace
}  // namespace biotomy::tests
