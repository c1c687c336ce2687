#include "acquisition/service/event_source.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquisition/records/layer_journal.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using TimePoint = std::chrono::steady_clock::time_point;
using testing::HasSubstr;
using testing::StartsWith;

/// Reads on until an event with `part` comes; empty when none does within half a minute.
std::string next_with(EventSubscription& listener, const std::string& part) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (std::chrono::steady_clock::now() < deadline) {
    for (const EventText& text : listener.take()) {
      if (text->find(part) != std::string::npos) return *text;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ADD_FAILURE() << "no event with " << part;
  return {};
}

TEST(EventSource, TellsWhatHasChanged) {
  const TemporaryFolder folder;
  LayerJournal journal(folder.path() / "journal.sqlite");
  AttemptRow row;
  row.layer = 1;
  row.attempt = 1;
  row.assessment.slug = "blurred";
  journal.record_attempt(row);
  AttemptWatch attempts(folder.path() / "journal.sqlite");
  std::atomic<int> state = 1;
  EventFeed feed;
  const EventSource source(feed,
                           {.status = [&] { return "{\"state\":" + std::to_string(state) + "}"; },
                            .sample = [] { return std::string("{\"generation\":7}"); },
                            .attempts = &attempts});
  const auto listener = feed.subscribe();
  EXPECT_EQ(listener->begins_after(), 1);
  EXPECT_EQ(next_with(*listener, "state"), "event: status\ndata: {\"state\":1}\n\n");
  state = 2;
  EXPECT_EQ(next_with(*listener, "state"), "event: status\ndata: {\"state\":2}\n\n");
  row.attempt = 2;
  journal.record_attempt(row);
  EXPECT_THAT(next_with(*listener, "attempt"),
              testing::AllOf(StartsWith("id: 2\nevent: attempt\ndata: {"),
                             HasSubstr("\"slug\":\"blurred\"")));
  const auto later = feed.subscribe();
  EXPECT_EQ(next_with(*later, "generation"), "event: sample\ndata: {\"generation\":7}\n\n");
}

TEST(EventSource, GoesOnAfterWhatItCouldNotSee) {
  EventFeed feed;
  std::atomic<bool> broken = true;
  const EventSource source(feed, {.status =
                                      [&] {
                                        if (broken) throw std::runtime_error("the disk is away");
                                        return std::string("{}");
                                      },
                                  .sample = {}});
  const auto listener = feed.subscribe();
  EXPECT_TRUE(listener->take().empty());
  broken = false;
  EXPECT_EQ(next_with(*listener, "status"), "event: status\ndata: {}\n\n");
}

TEST(EventSource, TellsOfTheRigWhileTheSamplesDiskDoesNotAnswer) {
  EventFeed feed;
  const auto listener = feed.subscribe();
  std::atomic<int> state = 1;
  std::promise<void> answers;
  const std::shared_future<void> answered = answers.get_future();
  const EventSource source(feed,
                           {.status = [&] { return "{\"state\":" + std::to_string(state) + "}"; },
                            .sample =
                                [&] {
                                  answered.wait();
                                  return std::string("{}");
                                }});
  EXPECT_EQ(next_with(*listener, "state"), "event: status\ndata: {\"state\":1}\n\n");
  state = 2;
  EXPECT_EQ(next_with(*listener, "state"), "event: status\ndata: {\"state\":2}\n\n");
  answers.set_value();
  EXPECT_EQ(next_with(*listener, "sample"), "event: sample\ndata: {}\n\n");
}

TEST(EventSource, GivesSignsOfLifeByTheClockHoweverLongItsLooksTake) {
  EventFeed feed;
  const auto listener = feed.subscribe();
  std::atomic<int> looks = 0;
  std::promise<void> heard;
  const std::shared_future<void> is_heard = heard.get_future();
  const auto see = [&] {
    if (++looks == 10) is_heard.wait();
    return std::string("{}");
  };
  const EventSource source(feed, {.status = see, .sample = {}},
                           [&] { return TimePoint(looks.load() * std::chrono::seconds(2)); });
  EXPECT_EQ(next_with(*listener, ": \n"), ": \n\n");
  EXPECT_GE(looks, 3);
  heard.set_value();
}

TEST(Exports, AreToldEachByItsId) {
  EventFeed feed;
  const auto listener = feed.subscribe();
  tell_export(feed, R"({"id":"a","done":1})");
  tell_export(feed, R"({"id":"b","done":2})");
  tell_export(feed, R"({"id":"a","done":3})");
  tell_export(feed, "no JSON");
  const std::vector<EventText> heard = listener->take();
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_EQ(*heard[0], "event: export\ndata: {\"id\":\"a\",\"done\":3}\n\n");
  EXPECT_TRUE(feed.subscribe()->take().empty());
}

}  // namespace
}  // namespace biotomy::tests
