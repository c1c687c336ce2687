#include "acquisition/http/http_server.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/resource.h>
#include <unistd.h>

#include "acquisition/http/event_feed.hpp"
#include "tests/acquisition/http/raw_client.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::milliseconds;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

/// Answers as it is told; whatever begins with /picture is a picture, with /command a command.
struct FakeApplication : HttpApplication {
  std::function<ApiResponse(const ApiRequest&)> answers = [](const ApiRequest& request) {
    return ApiResponse{.content_type = "text/plain",
                       .body = request.method + " " + request.path + " " + request.body};
  };

  mutable std::atomic<int> asked = 0;  // requests that have arrived

  Lane lane(const ApiRequest& request) const override {
    ++asked;
    if (request.path.starts_with("/command")) return Lane::commands;
    return request.path.starts_with("/picture") ? Lane::pictures : Lane::quick;
  }
  ApiResponse answer(const ApiRequest& request) const override { return answers(request); }
};

constexpr std::chrono::seconds kPatience{30};

/// Work that goes on until it is let go, and counts who is at it.
class Gate {
 public:
  void pass() {
    std::unique_lock lock(mutex_);
    ++inside_;
    changed_.notify_all();
    changed_.wait_for(lock, kPatience, [this] { return open_; });
  }
  void wait_for(int inside) {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, kPatience, [&] { return inside_ >= inside; }));
  }
  void open() {
    const std::scoped_lock lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int inside_ = 0;
  bool open_ = false;
};

void wait_until(const std::function<bool()>& done) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!done()) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "it did not come to that";
    std::this_thread::sleep_for(milliseconds(1));
  }
}

struct HttpServerTest : testing::Test {
  FakeApplication application;
  HttpSettings settings;
  std::optional<HttpServer> server;

  int start() {
    server.emplace(application, "127.0.0.1", 0, settings);
    return server->port();
  }
};

/// Ends a server before what its answers use, which a test declares first.
class EndsFirst {
 public:
  explicit EndsFirst(std::optional<HttpServer>& server) : server_(server) {}
  ~EndsFirst() { server_.reset(); }
  EndsFirst(const EndsFirst&) = delete;
  EndsFirst& operator=(const EndsFirst&) = delete;

 private:
  std::optional<HttpServer>& server_;
};

TEST_F(HttpServerTest, AnswersWhateverIsAsked) {
  httplib::Client client("127.0.0.1", start());
  client.set_keep_alive(true);
  EXPECT_EQ(client.Get("/a%20b")->body, "GET /a b ");
  EXPECT_EQ(client.Post("/c", "body", "text/plain")->body, "POST /c body");
  EXPECT_EQ(client.Delete("/d")->body, "DELETE /d ");
  const auto head = client.Head("/e");
  EXPECT_EQ(head->status, 200);
  EXPECT_EQ(head->get_header_value("Content-Length"), "7");
  EXPECT_TRUE(head->body.empty());
  EXPECT_EQ(client.Get("/f")->body, "GET /f ");
}

TEST_F(HttpServerTest, TurnsAwayWhatIsTooLargeWithAnAnswer) {
  const int port = start();
  httplib::Client client("127.0.0.1", port);
  EXPECT_EQ(client.Post("/", std::string(100000, 'x'), "text/plain")->status, 413);
  EXPECT_EQ(client.Post("/", std::string(3000000, 'x'), "text/plain")->status, 413);
  EXPECT_EQ(client.Get(("/" + std::string(9000, 'x')).c_str())->status, 414);
  EXPECT_EQ(client.Get("/", {{"X", std::string(20000, 'x')}})->status, 431);
  RawClient raw(port);
  raw.send("nonsense\r\n\r\n");
  EXPECT_THAT(raw.read_all(), AllOf(StartsWith("HTTP/1.1 400 "), HasSubstr("Connection: close"),
                                    HasSubstr("cannot be understood")));
}

TEST_F(HttpServerTest, AnswersUnderItsOwnNamesAlone) {
  httplib::Client client("127.0.0.1", start());
  EXPECT_EQ(client.Get("/", {{"Host", "evil.example"}})->status, 421);
  EXPECT_EQ(client.Get("/", {{"Origin", "http://evil.example"}})->status, 403);
  RawClient nameless(server->port());
  nameless.send("GET / HTTP/1.1\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(nameless.read_all(), StartsWith("HTTP/1.1 421 "));
}

TEST_F(HttpServerTest, AnswersOneAfterTheOtherWhatIsAskedAtOnce) {
  RawClient client(start());
  client.send(
      "GET /1 HTTP/1.1\r\nHost: localhost\r\n\r\nGET /2 HTTP/1.1\r\nHost: localhost\r\n\r\n"
      "GET /3 HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(client.read_until("GET /1 "), HasSubstr("keep-alive"));
  EXPECT_THAT(client.read_until("GET /2 "), HasSubstr("keep-alive"));
  EXPECT_THAT(client.read_all(), AllOf(HasSubstr("Connection: close"), EndsWith("GET /3 ")));
}

TEST_F(HttpServerTest, TellsAClientThatWaitsToSendItsBody) {
  RawClient client(start());
  client.send(
      "POST / HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\nContent-Length: 4\r\n\r\n");
  EXPECT_EQ(client.read_until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
  client.send("body");
  EXPECT_THAT(client.read_until("body"), StartsWith("HTTP/1.1 200 "));
}

TEST_F(HttpServerTest, GivesLooksLessPriorityThanTheRunAndPicturesLessStillButNotCommands) {
  const auto priority = [] { return ::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid())); };
  application.answers = [&](const ApiRequest&) {
    return ApiResponse{.body = std::to_string(priority())};
  };
  httplib::Client client("127.0.0.1", start());
  EXPECT_EQ(client.Post("/command")->body, std::to_string(priority()));
  EXPECT_EQ(client.Get("/quick")->body, std::to_string(std::min(priority() + 5, 19)));
  EXPECT_EQ(client.Get("/picture")->body, std::to_string(std::min(priority() + 10, 19)));
}

TEST_F(HttpServerTest, GoesOnAfterAnAnswerThatFailed) {
  application.answers = [](const ApiRequest& request) -> ApiResponse {
    if (request.path == "/fails") throw std::runtime_error("the disk is away");
    return {};
  };
  httplib::Client client("127.0.0.1", start());
  const auto failed = client.Get("/fails");
  EXPECT_EQ(failed->status, 500);
  EXPECT_THAT(failed->body, HasSubstr("the disk is away"));
  EXPECT_EQ(client.Get("/")->status, 200);
}

TEST_F(HttpServerTest, WritesNoHeaderThatCameFromElsewhere) {
  application.answers = [](const ApiRequest&) {
    return ApiResponse{.headers = {{"Biotomy-Section", "a\r\nSet-Cookie: b"}}};
  };
  httplib::Client client("127.0.0.1", start());
  const auto response = client.Get("/");
  EXPECT_EQ(response->get_header_value("Biotomy-Section"), "aSet-Cookie: b");
  EXPECT_FALSE(response->has_header("Set-Cookie"));
}

/// A server of which one lane works on a request for `path` and holds another, and has room for no
/// more until it is let go.
class FullLane {
 public:
  FullLane(HttpServerTest& test, LaneSize& lane, const std::string& path)
      : ends_first_(test.server) {
    test.application.answers = [this, path](const ApiRequest& request) {
      if (request.path == path) gate_.pass();
      return ApiResponse{};
    };
    lane = {.threads = 1, .most_waiting = 1};
    const int port = test.start();
    worked_on_.emplace(port).get(path);
    gate_.wait_for(1);
    waiting_.emplace(port).get(path);
    wait_until([&] { return test.application.asked == 2; });
  }

  /// What the request that waited is answered.
  std::string let_go() {
    gate_.open();
    return waiting_->read_until("\r\n\r\n");
  }

 private:
  Gate gate_;
  EndsFirst ends_first_;
  std::optional<RawClient> worked_on_;
  std::optional<RawClient> waiting_;
};

TEST_F(HttpServerTest, RefusesAtOnceWhatALaneHasNoRoomFor) {
  FullLane pictures(*this, settings.limits.pictures, "/picture");
  httplib::Client other("127.0.0.1", server->port());
  const auto refused = other.Get("/picture");
  EXPECT_EQ(refused->status, 503);
  EXPECT_EQ(refused->get_header_value("Retry-After"), "1");
  EXPECT_EQ(other.Get("/quick")->status, 200);
  EXPECT_THAT(pictures.let_go(), StartsWith("HTTP/1.1 200"));
}

TEST_F(HttpServerTest, TakesCommandsWhenThereIsNoRoomForLooks) {
  FullLane looks(*this, settings.limits.quick, "/look");
  httplib::Client operators("127.0.0.1", server->port());
  EXPECT_EQ(operators.Get("/look")->status, 503);
  EXPECT_EQ(operators.Post("/command")->status, 200);
  EXPECT_THAT(looks.let_go(), StartsWith("HTTP/1.1 200"));
}

TEST_F(HttpServerTest, TellsWorkThatItsClientHasLeft) {
  std::atomic<bool> begun = false;
  std::atomic<bool> noticed = false;
  const EndsFirst ends_first(server);
  application.answers = [&](const ApiRequest& request) {
    begun = true;
    wait_until(request.client_left);
    noticed = true;
    return ApiResponse{};
  };
  RawClient client(start());
  client.get("/");
  wait_until([&] { return begun.load(); });
  EXPECT_FALSE(noticed);
  client.leave();
  wait_until([&] { return noticed.load(); });
}

TEST_F(HttpServerTest, DoesNoWorkForWhoLeftWhileWaiting) {
  Gate gate;
  std::atomic<int> pictures = 0;
  const EndsFirst ends_first(server);
  application.answers = [&](const ApiRequest& request) {
    if (request.path == "/picture") {
      ++pictures;
      gate.pass();
    }
    return ApiResponse{};
  };
  settings.limits.pictures = {.threads = 1, .most_waiting = 3};
  const int port = start();
  RawClient worked_on(port);
  worked_on.get("/picture");
  gate.wait_for(1);
  {
    std::vector<RawClient> impatient;
    for (int i = 0; i < 3; ++i) impatient.emplace_back(port).get("/picture");
    wait_until([&] { return application.asked == 4; });
  }
  // The server's thread hears of them before it answers who came later.
  httplib::Client client("127.0.0.1", port);
  EXPECT_EQ(client.Get("/quick")->status, 200);
  EXPECT_EQ(client.Get("/quick")->status, 200);
  RawClient patient(port);
  patient.get("/picture");
  wait_until([&] { return application.asked == 7; });
  gate.open();
  EXPECT_THAT(patient.read_until("\r\n\r\n"), StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(pictures, 2);
}

TEST_F(HttpServerTest, LimitsThePicturesOfAnAddress) {
  settings.limits.pictures_per_second = 1;
  httplib::Client client("127.0.0.1", start());
  int refused = 0;
  for (int i = 0; i < 20; ++i) refused += client.Get("/picture")->status == 429 ? 1 : 0;
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, 20);
  EXPECT_EQ(client.Get("/quick")->status, 200);
}

TEST_F(HttpServerTest, LimitsTheConnectionsOfAnAddress) {
  settings.limits.connections_of_an_address = 2;
  const int port = start();
  RawClient first(port);
  RawClient second(port);
  first.get("/1");
  EXPECT_THAT(first.read_until("GET /1 "), StartsWith("HTTP/1.1 200"));
  second.get("/2");
  EXPECT_THAT(second.read_until("GET /2 "), StartsWith("HTTP/1.1 200"));
  RawClient third(port);
  EXPECT_THAT(third.read_all(), StartsWith("HTTP/1.1 503"));
  first.leave();
  wait_until([&] {
    httplib::Client again("127.0.0.1", port);
    const auto response = again.Get("/again");
    return response && response->status == 200;
  });
}

std::shared_ptr<const bridge::UniqueFd> opened(const std::filesystem::path& file) {
  return std::make_shared<const bridge::UniqueFd>(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
}

TEST_F(HttpServerTest, SendsAPartOfAFile) {
  const TemporaryFolder folder;
  std::string content(5'000'000, '\0');
  for (std::size_t i = 0; i < content.size(); ++i) content[i] = static_cast<char>(i * i >> 7U);
  std::ofstream(folder.path() / "part", std::ios::binary) << content;
  const EndsFirst ends_first(server);
  application.answers = [&](const ApiRequest&) {
    return ApiResponse{.status = 206,
                       .content_type = "application/octet-stream",
                       .file = FilePart{opened(folder.path() / "part"), 1000, 4'000'000}};
  };
  httplib::Client client("127.0.0.1", start());
  client.set_keep_alive(true);
  for (int i = 0; i < 2; ++i) {
    const auto response = client.Get("/");
    EXPECT_EQ(response->status, 206);
    EXPECT_TRUE(response->body == content.substr(1000, 4'000'000));
  }
  EXPECT_EQ(client.Head("/")->get_header_value("Content-Length"), "4000000");
}

TEST_F(HttpServerTest, EndsEarlyWhenAFileBecameShorter) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "short") << "12345";
  const EndsFirst ends_first(server);
  application.answers = [&](const ApiRequest&) {
    return ApiResponse{.file = FilePart{opened(folder.path() / "short"), 0, 10}};
  };
  RawClient client(start());
  client.get("/");
  EXPECT_THAT(client.read_all(), AllOf(HasSubstr("Content-Length: 10"), EndsWith("\r\n\r\n")));
}

TEST_F(HttpServerTest, DropsWhoIsSlowWithARequest) {
  settings.limits.request_time = milliseconds(50);
  RawClient client(start());
  client.send("GET / HTTP/1.1\r\n");
  EXPECT_EQ(client.read_all(), "");
}

TEST_F(HttpServerTest, DropsWhoSendsABodyByteByByte) {
  settings.limits.request_time = milliseconds(200);
  RawClient client(start());
  client.send("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\n");
  const std::jthread dripping([&](const std::stop_token& stop) {
    for (int i = 0; i < 999 && !stop.stop_requested(); ++i) {
      std::this_thread::sleep_for(milliseconds(20));
      client.send("x");
    }
  });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(client.read_all(), "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST_F(HttpServerTest, EndsAConnectionThatIsIdle) {
  settings.limits.idle_time = milliseconds(50);
  RawClient client(start());
  client.get("/");
  EXPECT_THAT(client.read_all(), EndsWith("GET / "));
}

TEST_F(HttpServerTest, DropsWhoDoesNotTakeTheAnswer) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "large") << std::string(50'000'000, 'x');
  const EndsFirst ends_first(server);
  application.answers = [&](const ApiRequest&) {
    return ApiResponse{.file = FilePart{opened(folder.path() / "large"), 0, 50'000'000}};
  };
  settings.limits.write_stall = milliseconds(100);
  settings.limits.connections = 1;
  const int port = start();
  const RawClient slow(port, 4096);
  slow.get("/");
  // Its place becomes free.
  wait_until([&] {
    httplib::Client other("127.0.0.1", port);
    const auto response = other.Head("/");
    return response && response->status == 200;
  });
}

TEST_F(HttpServerTest, TellsEventsToFiftyWhileTenDoNotListen) {
  EventFeed feed;
  const EndsFirst ends_first(server);
  application.answers = [&](const ApiRequest&) {
    return ApiResponse{.content_type = "text/event-stream", .events = feed.subscribe()};
  };
  settings.limits.write_stall = milliseconds(2000);
  const int port = start();
  std::vector<RawClient> deaf;
  for (int i = 0; i < 10; ++i) deaf.emplace_back(port, 4096).get("/events");
  std::vector<std::thread> viewers;
  std::atomic<int> heard_all = 0;
  std::atomic<bool> all_heard = false;
  for (int i = 0; i < 50; ++i) {
    viewers.emplace_back([&] {
      RawClient viewer(port);
      viewer.get("/events");
      const std::string head = viewer.read_until("\r\n\r\n");
      int id = 0;
      bool last_status = false;
      while (id < 100 || !last_status) {
        const std::string event = viewer.read_until("\n\n");
        if (event.empty()) return;
        if (event == "id: " + std::to_string(id + 1) + "\nevent: attempt\ndata: {}\n\n") ++id;
        last_status = last_status || event.find("\"last\"") != std::string::npos;
      }
      if (head.find("text/event-stream") != std::string::npos) ++heard_all;
      wait_until([&] { return all_heard.load(); });
    });
  }
  wait_until([&] { return feed.listeners() == 60; });
  const std::string large(20000, 'x');
  for (int i = 1; i <= 100; ++i) {
    feed.tell_state("status", "status", "\"" + large + std::to_string(i) + "\"");
    feed.tell(i, event_text("attempt", "{}", i));
  }
  feed.tell_state("status", "status", R"("last")");
  // Whoever does not listen is dropped; the rest stay.
  wait_until([&] {
    feed.tell_state("status", "status", R"("last")");
    return feed.listeners() <= 50;
  });
  all_heard = true;
  for (std::thread& viewer : viewers) viewer.join();
  EXPECT_EQ(heard_all, 50);
  for (RawClient& client : deaf) {
    EXPECT_LT(client.read_all().size(), 1'000'000U);  // of 2 MB that was told meanwhile
  }
}

TEST_F(HttpServerTest, EndsWithStreamsOpenAndWorkUnderWay) {
  EventFeed feed;
  std::atomic<bool> begun = false;
  const EndsFirst ends_first(server);
  application.answers = [&](const ApiRequest& request) {
    if (request.path == "/events") {
      return ApiResponse{.content_type = "text/event-stream", .events = feed.subscribe()};
    }
    begun = true;
    wait_until(request.client_left);
    return ApiResponse{};
  };
  const int port = start();
  RawClient listener(port);
  listener.get("/events");
  wait_until([&] { return feed.listeners() == 1; });
  RawClient worked_on(port);
  worked_on.get("/");
  wait_until([&] { return begun.load(); });
  server.reset();
  EXPECT_EQ(feed.listeners(), 0U);
  feed.tell(1, event_text("attempt", "{}", 1));
  EXPECT_EQ(worked_on.read_all(), "");
}

TEST_F(HttpServerTest, RefusesAPortThatIsTaken) {
  const int port = start();
  EXPECT_TRUE(listen_complaint("127.0.0.1", port));
  EXPECT_THAT([&] { const HttpServer second(application, "127.0.0.1", port); },
              testing::ThrowsMessage<ListenError>(AllOf(
                  HasSubstr("Address already in use"), HasSubstr("another program has the port"))));
  server.reset();
  EXPECT_FALSE(listen_complaint("127.0.0.1", port));
}

}  // namespace
}  // namespace biotomy::tests
