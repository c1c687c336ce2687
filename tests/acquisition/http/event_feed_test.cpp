#include "acquisition/http/event_feed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace biotomy::tests {
namespace {

using namespace acquisition;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> heard(EventSubscription& listener) {
  std::vector<std::string> texts;
  for (const EventText& text : listener.take()) texts.push_back(*text);
  return texts;
}

TEST(EventFeed, WritesEventsAsBrowsersReadThem) {
  EXPECT_EQ(*event_text("attempt", R"({"layer":1})", 7),
            "id: 7\nevent: attempt\ndata: {\"layer\":1}\n\n");
  EXPECT_EQ(*event_text("status", "{}"), "event: status\ndata: {}\n\n");
  EXPECT_EQ(*place_text(0), "id: 0\n\n");
}

TEST(EventFeed, TellsStatesAtOnceToWhoeverComes) {
  EventFeed feed;
  feed.tell_state("status", "status", "1");
  feed.tell_state("export 1", "export", "2", EventFeed::AtOnce::no);
  feed.tell(1, event_text("attempt", "3", 1));
  const auto listener = feed.subscribe();
  EXPECT_EQ(listener->begins_after(), 1);
  EXPECT_THAT(heard(*listener), ElementsAre("event: status\ndata: 1\n\n"));
}

TEST(EventFeed, TellsOnlyTheLatestOfAStateAndAllThatIsNumbered) {
  EventFeed feed;
  const auto listener = feed.subscribe();
  for (int i = 1; i <= 3; ++i) {
    feed.tell_state("status", "status", std::to_string(i));
    feed.tell_state("export " + std::to_string(i % 2), "export", std::to_string(i));
    feed.tell(i, event_text("attempt", std::to_string(i), i));
    feed.tell_alive();
  }
  EXPECT_THAT(
      heard(*listener),
      ElementsAre("event: status\ndata: 3\n\n", "event: export\ndata: 3\n\n",
                  "id: 1\nevent: attempt\ndata: 1\n\n", ": \n\n", "event: export\ndata: 2\n\n",
                  "id: 2\nevent: attempt\ndata: 2\n\n", "id: 3\nevent: attempt\ndata: 3\n\n"));
  EXPECT_THAT(heard(*listener), IsEmpty());
}

TEST(EventFeed, TellsWhoFellFarBehindToLoadAnew) {
  EventFeed feed;
  const auto listener = feed.subscribe();
  feed.tell_state("status", "status", "{}");
  for (int i = 1; i <= 5000; ++i) feed.tell(i, event_text("attempt", "{}", i));
  const std::vector<std::string> texts = heard(*listener);
  EXPECT_LE(texts.size(), 1001U);
  EXPECT_EQ(texts.at(0), "event: status\ndata: {}\n\n");
  EXPECT_EQ(texts.at(1), "id: 4001\nevent: reload\ndata: {}\n\n");
  EXPECT_EQ(texts.back(), "id: 5000\nevent: attempt\ndata: {}\n\n");
}

TEST(EventFeed, TellsFirstWhatWasMissed) {
  EventFeed feed;
  feed.tell_state("status", "status", "{}");
  const auto listener = feed.subscribe();
  feed.tell(3, event_text("attempt", "{}", 3));
  listener->catch_up({event_text("attempt", "{}", 1), event_text("attempt", "{}", 2)});
  EXPECT_THAT(
      heard(*listener),
      ElementsAre("id: 1\nevent: attempt\ndata: {}\n\n", "id: 2\nevent: attempt\ndata: {}\n\n",
                  "event: status\ndata: {}\n\n", "id: 3\nevent: attempt\ndata: {}\n\n"));
}

TEST(EventFeed, WakesAListenerOnceUntilItHasListened) {
  EventFeed feed;
  const auto listener = feed.subscribe();
  int woken = 0;
  listener->on_event([&] { ++woken; });
  feed.tell(1, event_text("attempt", "{}", 1));
  feed.tell(2, event_text("attempt", "{}", 2));
  EXPECT_EQ(woken, 1);
  listener->take();
  feed.tell(3, event_text("attempt", "{}", 3));
  EXPECT_EQ(woken, 2);
  listener->take();
  listener->on_event({});
  feed.tell(4, event_text("attempt", "{}", 4));
  EXPECT_EQ(woken, 2);
}

TEST(EventFeed, SharesOneTextAmongAll) {
  EventFeed feed;
  const auto one = feed.subscribe();
  const auto other = feed.subscribe();
  feed.tell_state("status", "status", "{}");
  EXPECT_EQ(one->take().at(0).get(), other->take().at(0).get());
}

TEST(EventFeed, ForgetsWhoLeft) {
  EventFeed feed;
  auto listener = feed.subscribe();
  EXPECT_EQ(feed.listeners(), 1U);
  listener.reset();
  EXPECT_EQ(feed.listeners(), 0U);
}

}  // namespace
}  // namespace biotomy::tests
