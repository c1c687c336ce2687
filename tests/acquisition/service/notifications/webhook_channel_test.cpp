#include "acquisition/service/notifications/webhook_channel.hpp"

#include <atomic>
#include <csignal>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include "acquisition/service/notifications/courier.hpp"
#include "acquisition/service/notifications/notice.hpp"
#include "tests/integration/listening_socket.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::milliseconds;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

constexpr milliseconds kTime{60000};

std::string message(const std::string& id = "the-id") {
  return notice_json(Notice{}, id);
}

/// A web server on this computer that answers a POST of /hook as it is told.
class HookServer {
 public:
  HookServer() {
    server_.Post("/hook", [this](const httplib::Request& request, httplib::Response& response) {
      const std::scoped_lock lock(mutex_);
      requests_.push_back(request);
      response.status = failures_ > 0 ? 503 : 200;
      response.set_content(failures_ > 0 ? "no room" : "thanks", "text/plain");
      if (failures_ > 0) --failures_;
    });
    server_.Post("/elsewhere", [](const httplib::Request&, httplib::Response& response) {
      response.set_redirect("/hook");
    });
    server_.Post("/picky", [](const httplib::Request&, httplib::Response& response) {
      response.status = 422;
    });
    server_.Post("/silent", [](const httplib::Request&, httplib::Response& response) {
      response.status = 204;
    });
    server_.Post("/talkative", [](const httplib::Request&, httplib::Response& response) {
      response.set_content(std::string(10'000'000, 'x'), "text/plain");
    });
    port_ = server_.bind_to_any_port("127.0.0.1");
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    server_.wait_until_ready_or_so();
  }
  ~HookServer() {
    server_.stop();
    thread_.join();
  }

  std::string origin() const { return "http://127.0.0.1:" + std::to_string(port_); }
  void fail(int times) {
    const std::scoped_lock lock(mutex_);
    failures_ = times;
  }
  std::vector<httplib::Request> requests() {
    const std::scoped_lock lock(mutex_);
    return requests_;
  }

 private:
  struct Server : httplib::Server {
    void wait_until_ready_or_so() {
      while (!is_running()) std::this_thread::yield();
    }
  };
  Server server_;
  int port_ = 0;
  std::thread thread_;
  std::mutex mutex_;
  int failures_ = 0;
  std::vector<httplib::Request> requests_;
};

auto delivering(WebhookChannel& channel, milliseconds time = kTime, std::stop_token stop = {}) {
  return [&channel, time, stop] { channel.deliver(message(), time, stop); };
}

/// SIGPIPE is ignored, as in the daemon.
class WebhookChannelTest : public testing::Test {
 protected:
  WebhookChannelTest() { std::signal(SIGPIPE, SIG_IGN); }
};

TEST(SplitUrl, TakesOriginAndPathApart) {
  const auto url = split_url("https://example.org:8443/hook/secret?x=1#part");
  ASSERT_TRUE(url);
  EXPECT_EQ(url->origin, "https://example.org:8443");
  EXPECT_EQ(url->path, "/hook/secret?x=1");
  EXPECT_EQ(split_url("http://example.org")->path, "/");
  EXPECT_EQ(split_url("http://example.org?x=1")->path, "/?x=1");
}

TEST(SplitUrl, TakesNothingElse) {
  for (const char* text : {"", "example.org", "ftp://a", "http://", "http:///x", "https://a b",
                           "http://user:word@example.org/", "http://a/\r\nX: y"}) {
    EXPECT_FALSE(split_url(text)) << text;
  }
}

TEST_F(WebhookChannelTest, PostsTheMessage) {
  HookServer server;
  WebhookChannel channel(*split_url(server.origin() + "/hook"), "a-token");
  channel.deliver(message(), kTime, {});
  const auto requests = server.requests();
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(requests[0].body, message());
  EXPECT_EQ(requests[0].get_header_value("Content-Type"), "application/json");
  EXPECT_EQ(requests[0].get_header_value("Idempotency-Key"), "the-id");
  EXPECT_EQ(requests[0].get_header_value("Authorization"), "Bearer a-token");
}

TEST_F(WebhookChannelTest, SaysWhatTheServerAnsweredButNotWhereTheHookIs) {
  HookServer server;
  server.fail(1);
  WebhookChannel channel(*split_url(server.origin() + "/hook"), "");
  EXPECT_THAT(delivering(channel), ThrowsMessage<DeliveryError>(AllOf(
                                       HasSubstr("status 503: no room"), Not(HasSubstr("/hook")))));
}

TEST_F(WebhookChannelTest, TellsARefusedMessageFromAServerThatFails) {
  HookServer server;
  server.fail(1);
  WebhookChannel failing(*split_url(server.origin() + "/hook"), "");
  EXPECT_THAT(delivering(failing), Not(testing::Throws<MessageRefused>()));
  WebhookChannel refusing(*split_url(server.origin() + "/picky"), "");
  EXPECT_THAT(delivering(refusing), testing::Throws<MessageRefused>());
}

TEST_F(WebhookChannelTest, FollowsNoRedirection) {
  HookServer server;
  WebhookChannel channel(*split_url(server.origin() + "/elsewhere"), "");
  EXPECT_THAT(delivering(channel), ThrowsMessage<DeliveryError>(HasSubstr("status 302")));
  EXPECT_TRUE(server.requests().empty());
}

TEST_F(WebhookChannelTest, TakesAnAnswerWithoutWords) {
  HookServer server;
  WebhookChannel channel(*split_url(server.origin() + "/silent"), "");
  EXPECT_NO_THROW(channel.deliver(message(), kTime, {}));
}

TEST_F(WebhookChannelTest, NeedsNoMoreThanTheStatusOfAnAnswer) {
  HookServer server;
  WebhookChannel channel(*split_url(server.origin() + "/talkative"), "");
  EXPECT_NO_THROW(channel.deliver(message(), kTime, {}));
}

TEST_F(WebhookChannelTest, SaysWhenNobodyAnswers) {
  std::string address;
  { address = ListeningSocket().address(); }
  WebhookChannel channel(*split_url("http://" + address), "");
  EXPECT_THAT(delivering(channel), ThrowsMessage<DeliveryError>(HasSubstr("does not answer")));
}

TEST_F(WebhookChannelTest, WaitsNoLongerThanItsTime) {
  const ListeningSocket silent;
  WebhookChannel channel(*split_url("http://" + silent.address()), "");
  EXPECT_THAT(delivering(channel, milliseconds(200)), testing::Throws<DeliveryError>());
}

TEST_F(WebhookChannelTest, GivesUpWhenTheDaemonStops) {
  const ListeningSocket silent;
  WebhookChannel channel(*split_url("http://" + silent.address()), "");
  std::stop_source source;
  source.request_stop();
  EXPECT_THAT(delivering(channel, kTime, source.get_token()),
              ThrowsMessage<DeliveryError>(HasSubstr("given up with the daemon")));
}

TEST_F(WebhookChannelTest, ReachesAServerThatFailsAtFirst) {
  HookServer server;
  server.fail(4);
  const TemporaryFolder folder;
  Courier courier(std::make_unique<WebhookChannel>(*split_url(server.origin() + "/hook"), ""),
                  folder / "queue",
                  {.keep = 10,
                   .time_out = kTime,
                   .first_retry = milliseconds(1),
                   .longest_retry = milliseconds(10)});
  courier.take(message("first"));
  courier.take(message("second"));
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (courier.figures().delivered < 2 && std::chrono::steady_clock::now() < limit) {
    std::this_thread::yield();
  }
  const auto requests = server.requests();
  ASSERT_EQ(requests.size(), 6U);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(requests[i].get_header_value("Idempotency-Key"), "first");
  EXPECT_EQ(requests[5].get_header_value("Idempotency-Key"), "second");
}

}  // namespace
}  // namespace biotomy::tests
