#include "acquisition/service/api.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <future>
#include <optional>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "acquisition/log.hpp"
#include "acquisition/records/journal_reader.hpp"
#include "acquisition/service/status_json.hpp"
#include "acquisition/service/status_page.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::int64_t kDefaultLimit = 100;
constexpr std::int64_t kLargestLimit = 1000;
constexpr std::int64_t kLargestLayer = 999999;
constexpr std::size_t kLongestReason = 500;
constexpr std::string_view kControl = "/api/v1/control/";
constexpr const char* kHealth = "/healthz";
constexpr const char* kMetrics = "/metrics";
constexpr const char* kStatus = "/api/v1/status";
constexpr const char* kLayers = "/api/v1/layers";
constexpr const char* kPage = "/";
constexpr std::array kReadable = {kHealth, kMetrics, kStatus, kLayers, kPage};

ApiResponse json_response(std::string body) {
  return {
      .status = 200, .content_type = "application/json", .body = std::move(body), .headers = {}};
}

/// The number under `name`; nothing when it is not a whole number in the range.
std::optional<std::int64_t> number(const ApiRequest& request, const std::string& name,
                                   std::int64_t fallback, std::int64_t minimum,
                                   std::int64_t maximum) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) return fallback;
  const std::string& text = found->second;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (value < minimum || value > maximum) return std::nullopt;
  return value;
}

/// The operator's words in a body {"reason": "…"}; an empty body has none. Nothing when the body is
/// something else.
std::optional<std::string> reason_of(const std::string& body) {
  if (body.empty()) return "";
  const nlohmann::json document = nlohmann::json::parse(body, nullptr, false);
  if (!document.is_object()) return std::nullopt;
  if (document.empty()) return "";
  if (document.size() != 1 || !document.contains("reason")) return std::nullopt;
  if (!document["reason"].is_string()) return std::nullopt;
  return document["reason"].get<std::string>().substr(0, kLongestReason);
}

ApiResponse wrong_method(const ApiRequest& request, const char* allowed) {
  ApiResponse response =
      error_response(405, request.path + " takes " + allowed + ", not " + request.method);
  response.headers["Allow"] = allowed;
  return response;
}

ApiResponse refusal(const Ruling& ruling) {
  ApiResponse response = error_response(ruling.status, ruling.sentence);
  if (ruling.status == 401) response.headers["WWW-Authenticate"] = "Bearer";
  if (ruling.status == 429) {
    response.headers["Retry-After"] = std::to_string(ruling.retry_after.count());
  }
  return response;
}

}  // namespace

Api::Api(ApiParts parts, std::chrono::milliseconds reply_time_out)
    : parts_(std::move(parts)), reply_time_out_(reply_time_out) {}

ApiResponse Api::answer(const ApiRequest& request) const {
  try {
    if (request.path.starts_with(kControl)) {
      return control(request.path.substr(kControl.size()), request);
    }
    if (std::find(kReadable.begin(), kReadable.end(), request.path) == kReadable.end()) {
      return error_response(404, "there is no " + request.path);
    }
    if (request.method != "GET") return wrong_method(request, "GET");
    if (request.path == kHealth) return json_response(R"({"status":"ok"})");
    const Ruling ruling =
        parts_.access.reading(request.client, request.authorization, "reading " + request.path);
    return ruling.granted ? read(request) : refusal(ruling);
  } catch (const std::exception& error) {
    log_error("http", request.path + ": " + error.what());
    return error_response(500, error.what());
  }
}

ApiResponse Api::read(const ApiRequest& request) const {
  if (request.path == kStatus) return json_response(status_json(*parts_.board.look()));
  if (request.path == kLayers) return layers(request);
  if (request.path == kMetrics) {
    return {.status = 200,
            .content_type = "text/plain; version=0.0.4; charset=utf-8",
            .body = parts_.metrics(),
            .headers = {}};
  }
  ApiResponse page{.status = 200,
                   .content_type = "text/html; charset=utf-8",
                   .body = status_page(*parts_.board.look()),
                   .headers = {}};
  page.headers["Content-Security-Policy"] = "default-src 'none'; style-src 'unsafe-inline'";
  return page;
}

ApiResponse Api::layers(const ApiRequest& request) const {
  const auto from = number(request, "from", 1, 1, kLargestLayer);
  if (!from) return error_response(400, "from must be a layer number, 1 to 999999");
  const auto limit = number(request, "limit", kDefaultLimit, 1, kLargestLimit);
  if (!limit) return error_response(400, "limit must be a number from 1 to 1000");
  if (!std::filesystem::exists(parts_.journal)) return json_response(layers_json({}, 0));
  const JournalReader reader(parts_.journal);
  return json_response(
      layers_json(reader.committed_layers(*from, *limit), reader.committed_count()));
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
  if (reply.wait_for(reply_time_out_) != std::future_status::ready) {
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
