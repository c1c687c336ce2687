#include "acquisition/service/notifications/message_queue.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;

struct MessageQueueTest : testing::Test {
  TemporaryFolder folder;
  std::filesystem::path path = folder / "queue";

  static std::string message(int i) { return "{\"id\":" + std::to_string(i) + "}"; }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path), {}));
  }
};

TEST_F(MessageQueueTest, GivesMessagesInTheirOrder) {
  MessageQueue queue(path, 10);
  for (int i = 1; i <= 3; ++i) queue.push(message(i));
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(queue.front());
    EXPECT_EQ(queue.front()->text, message(i));
    queue.pop(queue.front()->number);
  }
  EXPECT_FALSE(queue.front());
  EXPECT_EQ(files(), 0U);
}

TEST_F(MessageQueueTest, IsTakenUpAgainAfterACrash) {
  {
    MessageQueue queue(path, 10);
    for (int i = 1; i <= 12; ++i) queue.push(message(i));
    queue.pop(queue.front()->number);
  }
  MessageQueue again(path, 20);
  again.push(message(13));
  for (int i = 4; i <= 13; ++i) {
    EXPECT_EQ(again.front()->text, message(i));
    again.pop(again.front()->number);
  }
  EXPECT_EQ(again.size(), 0U);
}

TEST_F(MessageQueueTest, LetsTheOldestGoWhenItIsFull) {
  MessageQueue queue(path, 3);
  for (int i = 1; i <= 5; ++i) queue.push(message(i));
  EXPECT_EQ(queue.size(), 3U);
  EXPECT_EQ(queue.dropped(), 2U);
  EXPECT_EQ(queue.front()->text, message(3));
  EXPECT_EQ(files(), 3U);
}

TEST_F(MessageQueueTest, PutsAMessageBehindTheOthersUntilItIsOpenedAnew) {
  {
    MessageQueue queue(path, 3);
    for (int i = 1; i <= 3; ++i) queue.push(message(i));
    queue.postpone(queue.front()->number);
    EXPECT_EQ(queue.front()->text, message(2));
    queue.push(message(4));  // the oldest goes, wherever it stands
    queue.pop(queue.front()->number);
    EXPECT_EQ(queue.front()->text, message(3));
    queue.postpone(queue.front()->number);
    EXPECT_EQ(queue.front()->text, message(4));
  }
  EXPECT_EQ(MessageQueue(path, 3).front()->text, message(3));
}

TEST_F(MessageQueueTest, DoesNotMindAMessageThatHasGoneMeanwhile) {
  MessageQueue queue(path, 1);
  queue.push(message(1));
  const std::uint64_t number = queue.front()->number;
  queue.push(message(2));
  queue.pop(number);
  EXPECT_EQ(queue.front()->text, message(2));
}

TEST_F(MessageQueueTest, LeavesAloneWhatIsNoMessage) {
  std::filesystem::create_directory(path);
  std::ofstream(path / "000000000007.json") << "{\"id\":";  // torn
  std::ofstream(path / "notes.txt") << "x";
  MessageQueue queue(path, 10);
  EXPECT_EQ(queue.size(), 0U);
  queue.push(message(1));
  EXPECT_EQ(queue.front()->number, 8U);
}

TEST_F(MessageQueueTest, KeepsAMessageInMemoryWhenTheDiskTakesNone) {
  MessageQueue queue(path, 10);
  std::filesystem::remove(path);
  queue.push(message(1));
  EXPECT_EQ(queue.front()->text, message(1));
}

}  // namespace
}  // namespace biotomy::tests
