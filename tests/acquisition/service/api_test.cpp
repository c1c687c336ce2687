#include "acquisition/service/api.hpp"

#include <chrono>
#include <optional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include "acquisition/records/layer_journal.hpp"
#include "acquisition/service/http_server.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

/// An operator's desk that somebody answers, always in the same way.
class AnsweredDesk {
 public:
  explicit AnsweredDesk(OperatorReply reply)
      : thread_([this, reply](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            for (OperatorDesk::Request& request : desk.take()) request.reply.set_value(reply);
            std::this_thread::yield();
          }
        }) {}
  OperatorDesk desk;

 private:
  std::jthread thread_;
};

struct ApiTest : testing::Test {
  TemporaryFolder folder;
  StatusBoard board;
  OperatorDesk desk;
  AccessSettings settings;
  Access access{Credentials::parse(kToken, "token"), settings,
                [] { return TimePoint(std::chrono::hours(1)); }, [](const std::string&) {}};
  std::optional<Api> api = answered_by(desk, access);

  Api patient(OperatorDesk& on) { return Api({board, on, access, {}, {}}); }

  Api answered_by(OperatorDesk& on, Access& door) {
    return Api({board, on, door, folder.path() / "journal.sqlite",
                [] { return std::string("biotomy_job_layers 5\n"); }},
               std::chrono::milliseconds(10));
  }

  ApiResponse get(const std::string& path, std::map<std::string, std::string> query = {}) const {
    return api->answer(
        {.method = "GET", .path = path, .query = std::move(query), .client = "127.0.0.1"});
  }

  ApiResponse post(const std::string& path, const std::string& authorization,
                   const std::string& body = "") const {
    return api->answer({.method = "POST",
                        .path = path,
                        .authorization = authorization,
                        .body = body,
                        .client = "10.0.0.7"});
  }
};

TEST_F(ApiTest, ShowsTheStatus) {
  JobStatus status;
  status.state = JobState::grinding;
  status.waiting_for = "waits for the wheel";
  status.committed = 41;
  status.layers = 1000;
  status.alarm = Alarm{"the door is open", "2026-11-22T03:04:05.678Z", JobState::grinding};
  status.stage = bridge::StageStatus{};
  board.publish(status);
  const ApiResponse response = get("/api/v1/status");
  EXPECT_EQ(response.status, 200);
  const json document = json::parse(response.body);
  EXPECT_EQ(document.at("state"), "grinding");
  EXPECT_EQ(document.at("committed"), 41);
  EXPECT_EQ(document.at("alarm").at("cause"), "the door is open");
  EXPECT_EQ(document.at("alarm").at("state"), "grinding");
  EXPECT_EQ(document.at("stage").at("positions_um").at("feed"), 0.0);
  EXPECT_EQ(document.at("version"), BIOTOMY_VERSION);
}

TEST_F(ApiTest, ShowsAPageInWhichNamesAreNoMarkup) {
  JobStatus status;
  status.job = "<script>alert(1)</script>";
  board.publish(status);
  const ApiResponse response = get("/");
  EXPECT_THAT(response.content_type, HasSubstr("text/html"));
  EXPECT_THAT(response.body, HasSubstr("&lt;script&gt;"));
  EXPECT_THAT(response.body, testing::Not(HasSubstr("<script>")));
}

TEST_F(ApiTest, ListsCommittedLayersPageByPage) {
  EXPECT_EQ(json::parse(get("/api/v1/layers").body).at("count"), 0);
  LayerJournal journal(folder.path() / "journal.sqlite");
  for (std::int64_t layer = 1; layer <= 5; ++layer) {
    AttemptRow row;
    row.layer = layer;
    row.attempt = 1;
    row.assessment.verdict = Verdict::accepted;
    journal.commit_layer(row, 10, "2026-11-22T03:04:05.678Z");
  }
  const json page = json::parse(get("/api/v1/layers", {{"from", "2"}, {"limit", "3"}}).body);
  EXPECT_EQ(page.at("count"), 5);
  ASSERT_EQ(page.at("layers").size(), 3U);
  EXPECT_EQ(page.at("layers")[0].at("layer"), 2);
}

TEST_F(ApiTest, RefusesNumbersThatAreNone) {
  for (const char* text : {"0", "-1", "x", "1x", "", "99999999999999999999"}) {
    EXPECT_EQ(get("/api/v1/layers", {{"from", text}}).status, 400) << text;
  }
  EXPECT_EQ(get("/api/v1/layers", {{"limit", "1001"}}).status, 400);
}

TEST_F(ApiTest, KnowsWhatThereIsAndHowItIsAsked) {
  EXPECT_EQ(get("/healthz").status, 200);
  EXPECT_EQ(get("/nothing").status, 404);
  EXPECT_EQ(get("/api/v1/control/explode").status, 404);
  EXPECT_EQ(get("/api/v1/control/start").status, 405);
  EXPECT_EQ(get("/api/v1/control/start").headers.at("Allow"), "POST");
  const ApiResponse posted = post("/api/v1/status", "");
  EXPECT_EQ(posted.status, 405);
  EXPECT_EQ(json::parse(posted.body).at("error").at("code"), 405);
}

TEST_F(ApiTest, TakesNoCommandWithoutTheToken) {
  const std::string path = "/api/v1/control/abort";
  EXPECT_EQ(post(path, "").status, 401);
  EXPECT_EQ(post(path, "").headers.at("WWW-Authenticate"), "Bearer");
  EXPECT_EQ(post(path, "Bearer wrong").status, 403);
  EXPECT_TRUE(desk.take().empty());
}

TEST_F(ApiTest, SaysWhenACommandMayBeTriedAgain) {
  settings.commands_per_minute = 1;
  Access strict(
      Credentials::parse(kToken, "token"), settings,
      [] { return TimePoint(std::chrono::hours(1)); }, [](const std::string&) {});
  api.emplace(answered_by(desk, strict));
  const std::string authorization = std::string("Bearer ") + kToken;
  EXPECT_EQ(post("/api/v1/control/pause", authorization).status, 503);
  const ApiResponse second = post("/api/v1/control/pause", authorization);
  EXPECT_EQ(second.status, 429);
  EXPECT_EQ(second.headers.at("Retry-After"), "60");
}

TEST_F(ApiTest, ShowsNothingButItsHealthWithoutATokenWhenReadingNeedsOne) {
  settings.reading_needs_token = true;
  Access closed(
      Credentials::parse(kToken, "token"), settings,
      [] { return TimePoint(std::chrono::hours(1)); }, [](const std::string&) {});
  api.emplace(answered_by(desk, closed));
  for (const char* path : {"/", "/metrics", "/api/v1/status", "/api/v1/layers"}) {
    EXPECT_EQ(get(path).status, 401) << path;
    const ApiRequest known{.method = "GET",
                           .path = path,
                           .authorization = std::string("Bearer ") + kToken,
                           .client = "::1"};
    EXPECT_EQ(api->answer(known).status, 200) << path;
  }
  EXPECT_EQ(get("/healthz").status, 200);
}

TEST_F(ApiTest, ShowsTheMetricsAsPrometheusReadsThem) {
  const ApiResponse response = get("/metrics");
  EXPECT_EQ(response.status, 200);
  EXPECT_THAT(response.content_type, HasSubstr("text/plain; version=0.0.4"));
  EXPECT_EQ(response.body, "biotomy_job_layers 5\n");
}

TEST_F(ApiTest, TakesNoCommandItDoesNotUnderstand) {
  const std::string authorization = std::string("Bearer ") + kToken;
  for (const char* body : {"abort", "[]", R"({"force": true})", R"({"reason": 1})"}) {
    EXPECT_EQ(post("/api/v1/control/abort", authorization, body).status, 400);
  }
  EXPECT_THAT(desk.take_remarks(),
              testing::Contains("abort by operator from 10.0.0.7 was not understood").Times(4));
  EXPECT_TRUE(desk.take().empty());
}

TEST_F(ApiTest, SaysWhenTheControlDoesNotAnswer) {
  const std::string authorization = std::string("Bearer ") + kToken;
  EXPECT_EQ(post("/api/v1/control/pause", authorization).status, 503);
  const std::vector<OperatorDesk::Request> requests = desk.take();
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(requests[0].who, "operator from 10.0.0.7");
}

TEST_F(ApiTest, HandsOnWhatTheJobAnswers) {
  const std::string authorization = std::string("Bearer ") + kToken;
  const ApiRequest start{.method = "POST",
                         .path = "/api/v1/control/start",
                         .authorization = authorization,
                         .body = R"({"reason": "good evening"})",
                         .client = "::1"};
  {
    AnsweredDesk willing({true, "the checks have begun"});
    const Api answered = patient(willing.desk);
    const ApiResponse response = answered.answer(start);
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(json::parse(response.body).at("message"), "the checks have begun");
  }
  AnsweredDesk unwilling({false, "the job is grinding"});
  const Api answered = patient(unwilling.desk);
  const ApiResponse response = answered.answer(start);
  EXPECT_EQ(response.status, 409);
  EXPECT_EQ(json::parse(response.body).at("error").at("message"), "the job is grinding");
}

TEST_F(ApiTest, IsServedOverHttp) {
  const HttpServer server(*api, "127.0.0.1", 0);
  httplib::Client client("127.0.0.1", server.port());
  const auto health = client.Get("/healthz");
  ASSERT_TRUE(health);
  EXPECT_EQ(health->status, 200);
  const auto lost = client.Get("/nothing");
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->status, 404);
  EXPECT_THAT(lost->body, HasSubstr("there is no /nothing"));
  const auto large = client.Post("/api/v1/control/start", std::string(100000, 'x'), "text/plain");
  ASSERT_TRUE(large);
  EXPECT_EQ(large->status, 413);
}

TEST_F(ApiTest, RefusesAPortThatIsTaken) {
  const HttpServer first(*api, "127.0.0.1", 0);
  EXPECT_THAT([&] { const HttpServer second(*api, "127.0.0.1", first.port()); },
              testing::ThrowsMessage<ListenError>(HasSubstr("another program has the port")));
}

}  // namespace
}  // namespace biotomy::tests
