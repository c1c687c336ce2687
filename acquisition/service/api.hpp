#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

#include "acquisition/http/message.hpp"
#include "acquisition/job/job_status.hpp"
#include "acquisition/job/operator_desk.hpp"
#include "acquisition/service/access.hpp"

namespace biotomy::acquisition {

/// What the API looks at and speaks to. All outlive it.
struct ApiParts {
  const StatusBoard& board;
  OperatorDesk& desk;
  Access& access;
  std::filesystem::path journal;         ///< where the sample's journal is or will be
  std::function<std::string()> metrics;  ///< the text of /metrics, for any thread
};

/// What the daemon answers over HTTP, without a word of HTTP's own. It never touches a device: it
/// looks at the status board and at the journal, and lays commands on the operator's desk. Safe for
/// many threads.
class Api {
 public:
  explicit Api(ApiParts parts, std::chrono::milliseconds reply_time_out = std::chrono::seconds(5));

  /// Never throws: what goes wrong is a response with {"error": {"code", "message"}}.
  ApiResponse answer(const ApiRequest& request) const;

 private:
  ApiResponse read(const ApiRequest& request) const;
  ApiResponse layers(const ApiRequest& request) const;
  ApiResponse control(const std::string& name, const ApiRequest& request) const;

  ApiParts parts_;
  std::chrono::milliseconds reply_time_out_;
};

}  // namespace biotomy::acquisition
