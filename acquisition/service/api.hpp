#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/http/event_feed.hpp"
#include "acquisition/http/http_application.hpp"
#include "acquisition/http/page.hpp"
#include "acquisition/job/operator_desk.hpp"
#include "acquisition/service/access.hpp"
#include "acquisition/service/service_json.hpp"
#include "acquisition/viewer/sample_api.hpp"

namespace biotomy::acquisition {

/// What the API looks at and speaks to. All outlive it.
struct ApiParts {
  OperatorDesk& desk;
  Access& access;
  const Page& page;
  const SampleApi& sample;
  EventFeed& feed;
  std::filesystem::path journal;         ///< where the sample's journal is or will be
  ServiceDescription service;            ///< what is told to everybody
  std::function<std::string()> status;   ///< the JSON of /api/v1/status, for any thread
  std::function<std::string()> metrics;  ///< the text of /metrics, for any thread
};

/// What the daemon answers over HTTP, without a word of HTTP's own. It never touches a device: it
/// looks at the status board, the journal and the sample, and lays commands on the operator's desk.
/// Safe for many threads.
class Api : public HttpApplication {
 public:
  explicit Api(ApiParts parts, std::chrono::milliseconds reply_time_out = std::chrono::seconds(5));

  Lane lane(const ApiRequest& request) const override;
  ApiResponse answer(const ApiRequest& request) const override;

 private:
  ApiResponse sample(const ApiRequest& request) const;
  ApiResponse read(const ApiRequest& request) const;
  ApiResponse events(const ApiRequest& request) const;
  /// What a stream that begins after the attempt `begin` starts with, for who heard those up to
  /// `heard`, or none.
  std::vector<EventText> before(std::int64_t begin, std::optional<std::int64_t> heard) const;
  ApiResponse control(const std::string& name, const ApiRequest& request) const;

  ApiParts parts_;
  std::chrono::milliseconds reply_time_out_;
};

}  // namespace biotomy::acquisition
