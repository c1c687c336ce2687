#include "acquisition/service/api.hpp"

#include <algorithm>
#include <charconv>
#include <future>
#include <optional>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "acquisition/log.hpp"
#include "acquisition/service/api_paths.hpp"
#include "acquisition/service/attempt_watch.hpp"
#include "acquisition/service/event_source.hpp"
#include "acquisition/service/status_json.hpp"
#include "reconstruct/excerpt.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kLongestReason = 500;
constexpr std::string_view kControl = "/api/v1/control/";
constexpr std::string_view kMetrics = "/metrics";
constexpr std::string_view kStatus = "/api/v1/status";
constexpr std::chrono::milliseconds kReplyLook{50};  // while waiting: is the client still there?

/// The operator's words in a body {"reason": "…"}; an empty body has none. Nothing when the body is
/// something else.
std::optional<std::string> reason_of(const std::string& body) {
  if (body.empty()) return "";
  const nlohmann::json document = nlohmann::json::parse(body, nullptr, false);
  if (!document.is_object()) return std::nullopt;
  if (document.empty()) return "";
  if (document.size() != 1 || !document.contains("reason")) return std::nullopt;
  if (!document["reason"].is_string()) return std::nullopt;
  const auto reason = document["reason"].get<std::string>();
  return std::string(reconstruct::beginning_of(reason, kLongestReason));
}

ApiResponse refusal(const Ruling& ruling) {
  if (ruling.status == 429) {
    return later_response(ruling.status, ruling.sentence, ruling.retry_after);
  }
  ApiResponse response = error_response(ruling.status, ruling.sentence);
  // What another token would change: a page is to ask for one then, and after no other refusal.
  if (ruling.status == 401) response.headers["WWW-Authenticate"] = "Bearer";
  if (ruling.status == 403) {
    response.headers["WWW-Authenticate"] = R"(Bearer error="invalid_token")";
  }
  return response;
}

/// Waits no longer than the client does.
bool comes_in_time(const std::future<OperatorReply>& reply, std::chrono::milliseconds time,
                   const ApiRequest& request) {
  const auto limit = std::chrono::steady_clock::now() + time;
  while (true) {
    const auto left = limit - std::chrono::steady_clock::now();
    if (left <= left.zero() || (request.client_left && request.client_left())) return false;
    const auto wait = std::min<std::chrono::steady_clock::duration>(left, kReplyLook);
    if (reply.wait_for(wait) == std::future_status::ready) return true;
  }
}

}  // namespace

Api::Api(ApiParts parts, std::chrono::milliseconds reply_time_out)
    : parts_(std::move(parts)), reply_time_out_(reply_time_out) {}

Lane Api::lane(const ApiRequest& request) const {
  if (request.path.starts_with(kControl)) return Lane::commands;
  return parts_.sample.answers(request) ? SampleApi::lane(request) : Lane::quick;
}

ApiResponse Api::answer(const ApiRequest& request) const {
  if (request.path.starts_with(kControl)) {
    return control(request.path.substr(kControl.size()), request);
  }
  if (parts_.sample.answers(request)) return sample(request);
  if (parts_.page.answers(request)) return parts_.page.answer(request);
  if (!is_one_of(request.path, {kHealthPath, kServicePath, kEventsPath, kStatus, kMetrics})) {
    return error_response(404, "there is no " + request.path);
  }
  if (request.method != "GET") return wrong_method(request, "GET");
  if (request.path == kHealthPath) return json_response(kHealthy);
  if (request.path == kServicePath) return json_response(service_json(parts_.service));
  const Ruling ruling =
      parts_.access.reading(request.client, request.authorization, "reading " + request.path);
  return ruling.granted ? read(request) : refusal(ruling);
}

ApiResponse Api::sample(const ApiRequest& request) const {
  const std::string what =
      (request.method == "GET" ? "reading " : request.method + " ") + request.path;
  const Ruling ruling = SampleApi::is_command(request)
                            ? parts_.access.command(request.client, request.authorization, what)
                            : parts_.access.reading(request.client, request.authorization, what);
  return ruling.granted ? parts_.sample.answer(request) : refusal(ruling);
}

ApiResponse Api::read(const ApiRequest& request) const {
  if (request.path == kStatus) return json_response(parts_.status());
  if (request.path == kEventsPath) return events(request);
  return {.content_type = "text/plain; version=0.0.4; charset=utf-8", .body = parts_.metrics()};
}

ApiResponse Api::events(const ApiRequest& request) const {
  std::optional<std::int64_t> heard;
  if (const std::string& text = request.last_event_id; !text.empty()) {
    std::int64_t id = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (error != std::errc() || end != text.data() + text.size() || id < 0) {
      return error_response(400, "Last-Event-ID must be the number of an event");
    }
    heard = id;
  }
  auto subscription = parts_.feed.subscribe();
  subscription->catch_up(before(subscription->begins_after(), heard));
  return event_response(std::move(subscription));
}

std::vector<EventText> Api::before(std::int64_t begin, std::optional<std::int64_t> heard) const {
  if (!heard) return {place_text(begin)};
  const auto missed = missed_attempts(parts_.journal, *heard, begin);
  if (!missed) return {event_text("reload", "{}", begin)};
  std::vector<EventText> texts;
  for (const AttemptNote& attempt : *missed) texts.push_back(attempt_event(attempt));
  return texts;
}

ApiResponse Api::control(const std::string& name, const ApiRequest& request) const {
  const std::optional<OperatorCommand> command = operator_command(name);
  if (!command) {
    return error_response(404,
                          "there is no command \"" + name +
                              "\": it is start, pause, resume, abort, acknowledge, calibrate-flat, "
                              "calibrate-dark, calibrate-white or calibrate-focus");
  }
  if (request.method != "POST") return wrong_method(request, "POST");
  const Ruling ruling = parts_.access.command(request.client, request.authorization, name);
  if (!ruling.granted) return refusal(ruling);
  const std::optional<std::string> reason = reason_of(request.body);
  if (!reason) {
    parts_.desk.remark(name + " by " + ruling.who + " was not understood");
    return error_response(400, R"(the body must be empty or {"reason": "a few words"})");
  }
  std::future<OperatorReply> reply = parts_.desk.post(*command, *reason, ruling.who);
  if (!comes_in_time(reply, reply_time_out_, request)) {
    log_warning("operator", name + " by " + ruling.who + " was not answered in time");
    return error_response(503,
                          "the rig's control did not answer in time; look at the status "
                          "before asking again");
  }
  const OperatorReply answer = reply.get();
  if (!answer.accepted) return error_response(409, answer.sentence);
  return json_response(reply_json(answer.sentence));
}

}  // namespace biotomy::acquisition
