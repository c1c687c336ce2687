#include "acquisition/service/api.hpp"

#include <chrono>
#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include "acquisition/http/http_server.hpp"
#include "acquisition/records/layer_journal.hpp"
#include "acquisition/service/status_json.hpp"
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
  Page page{std::span<const PageAsset>()};
  SampleApi sample{folder.path(), {}};
  EventFeed feed;
  std::unique_ptr<Api> api = impatient(access);

  std::unique_ptr<Api> impatient(Access& door) {
    return std::make_unique<Api>(parts(desk, door), std::chrono::milliseconds(10));
  }

  ApiParts parts(OperatorDesk& on, Access& door) {
    return {.desk = on,
            .access = door,
            .page = page,
            .sample = sample,
            .feed = feed,
            .journal = folder.path() / "journal.sqlite",
            .service = {.reading_needs_token = settings.reading_needs_token,
                        .sample = "knee",
                        .neuroglancer = {}},
            .status = [this] { return status_json(*board.look(), {}); },
            .metrics = [] { return std::string("biotomy_job_layers 5\n"); }};
  }

  ApiResponse get(const std::string& path, const std::string& last_event_id = "") const {
    return api->answer(
        {.method = "GET", .path = path, .client = "127.0.0.1", .last_event_id = last_event_id});
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

TEST_F(ApiTest, LetsNoLookStandBeforeACommand) {
  EXPECT_EQ(api->lane({.method = "POST", .path = "/api/v1/control/abort"}), Lane::commands);
  EXPECT_EQ(api->lane({.path = "/api/v1/status"}), Lane::quick);
}

TEST_F(ApiTest, TellsWhatToDoAndWhatTheJobWouldObey) {
  JobStatus status;
  status.alarm =
      Alarm{"the door is open", "2026-11-22T03:04:05.678Z", JobState::grinding, AlarmKind::door};
  status.commands = {OperatorCommand::acknowledge, OperatorCommand::calibrate_flat};
  status.seconds_left = 100.0;
  status.seconds_left_range = TimeLeft::Range{90.0, 130.0};
  status.last_attempt = JudgedAttempt{3, 2, Verdict::rejected, "blurred", "it is blurred"};
  AttemptNote noted;
  noted.id = 17;
  noted.layer = 3;
  noted.attempt = 2;
  SafetyLimits limits;
  limits.block_temperature_minimum_c = -40.0;
  const json document = json::parse(status_json(status, {limits, noted}));
  EXPECT_THAT(document.at("alarm").at("advice"), HasSubstr("Close the door"));
  EXPECT_EQ(document.at("commands"), json({"acknowledge", "calibrate-flat"}));
  EXPECT_EQ(document.at("seconds_left_range"), json({90.0, 130.0}));
  EXPECT_EQ(document.at("limits").at("block_temperature_c"), json({-40.0, -5.0}));
  EXPECT_EQ(document.at("last_attempt").at("id"), 17);
  EXPECT_EQ(document.at("last_attempt").at("reason"), "it is blurred");

  noted.attempt = 1;  // the journal does not know the second yet
  EXPECT_TRUE(
      json::parse(status_json(status, {limits, noted})).at("last_attempt").at("id").is_null());
}

TEST_F(ApiTest, ServesThePageToEverybody) {
  const ApiResponse response = get("/");
  EXPECT_EQ(response.status, 200);
  EXPECT_THAT(response.content_type, HasSubstr("text/html"));
  EXPECT_THAT(response.body, HasSubstr("built without its page"));
}

TEST_F(ApiTest, DescribesItselfToWhoeverAsks) {
  settings.reading_needs_token = true;
  Access closed(
      Credentials::parse(kToken, "token"), settings,
      [] { return TimePoint(std::chrono::hours(1)); }, [](const std::string&) {});
  api = impatient(closed);
  const json service = json::parse(get("/api/v1/service").body);
  EXPECT_EQ(service.at("kind"), "rig");
  EXPECT_EQ(service.at("reading"), "token");
  EXPECT_EQ(service.at("sample"), "knee");
  EXPECT_TRUE(service.at("commands_need_token"));
  EXPECT_TRUE(service.at("neuroglancer").is_null());
}

TEST_F(ApiTest, TellsFirstWhatAListenerMissed) {
  LayerJournal journal(folder.path() / "journal.sqlite");
  for (std::int64_t layer = 1; layer <= 5; ++layer) {
    AttemptRow row;
    row.layer = layer;
    row.attempt = 1;
    journal.record_attempt(row);
  }
  feed.begin_after(4);  // the fifth has not been told yet
  const ApiResponse response = get("/api/v1/events", "2");
  ASSERT_TRUE(response.events);
  EXPECT_EQ(response.content_type, "text/event-stream");
  EXPECT_EQ(response.headers.at("X-Accel-Buffering"), "no");
  feed.tell(5, event_text("attempt", "{}", 5));
  const std::vector<EventText> heard = response.events->take();
  ASSERT_EQ(heard.size(), 3U);
  EXPECT_THAT(*heard[0], testing::StartsWith("id: 3\nevent: attempt\ndata: {"));
  EXPECT_THAT(*heard[1], testing::StartsWith("id: 4\n"));
  EXPECT_THAT(*heard[2], testing::StartsWith("id: 5\n"));

  // Of another journal, or of one that was begun anew.
  const ApiResponse stranger = get("/api/v1/events", "900");
  EXPECT_THAT(
      stranger.events->take(),
      testing::ElementsAre(testing::Pointee(std::string("id: 5\nevent: reload\ndata: {}\n\n"))));
  EXPECT_EQ(get("/api/v1/events", "x").status, 400);
}

TEST_F(ApiTest, TellsWhereTheStreamBeginsBeforeThereIsAnAttempt) {
  feed.begin_after(4);
  feed.tell_state("status", "status", "{}");
  const std::vector<EventText> heard = get("/api/v1/events").events->take();
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_EQ(*heard[0], "id: 4\n\n");
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
  EXPECT_EQ(post(path, "Bearer wrong").headers.at("WWW-Authenticate"),
            R"(Bearer error="invalid_token")");
  EXPECT_TRUE(desk.take().empty());
}

TEST_F(ApiTest, SaysWhenACommandMayBeTriedAgain) {
  settings.commands_per_minute = 1;
  Access strict(
      Credentials::parse(kToken, "token"), settings,
      [] { return TimePoint(std::chrono::hours(1)); }, [](const std::string&) {});
  api = impatient(strict);
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
  api = impatient(closed);
  for (const char* path : {"/metrics", "/api/v1/status", "/api/v1/events"}) {
    EXPECT_EQ(get(path).status, 401) << path;
    const ApiRequest known{.method = "GET",
                           .path = path,
                           .authorization = std::string("Bearer ") + kToken,
                           .client = "::1"};
    EXPECT_EQ(api->answer(known).status, 200) << path;
  }
  EXPECT_EQ(get("/api/v1/sample").status, 401);
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
    const Api answered(parts(willing.desk, access));
    const ApiResponse response = answered.answer(start);
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(json::parse(response.body).at("message"), "the checks have begun");
  }
  AnsweredDesk unwilling({false, "the job is grinding"});
  const Api answered(parts(unwilling.desk, access));
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
}

}  // namespace
}  // namespace biotomy::tests
