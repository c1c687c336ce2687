#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>

#include "acquisition/http/rate_limit.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "acquisition/service/credentials.hpp"
#include "acquisition/service/refusal_log.hpp"

namespace biotomy::acquisition {

struct AccessSettings {
  bool reading_needs_token = false;
  int failed_tokens_per_minute = 10;  ///< of one client
  int commands_per_minute = 60;       ///< of one client
};

/// Whether a request is let in; if not, the HTTP status and the sentence that say why.
struct Ruling {
  bool granted = false;
  std::string who;  ///< "anna from 192.168.7.20", for the records
  int status = 200;
  std::string sentence;
  std::chrono::seconds retry_after{0};  ///< of status 429
};

/// The door of the HTTP service. A client is its address: tokens that it got wrong and commands
/// that it gave are counted by it. Whoever gave too many wrong tokens is turned away before the
/// next is looked at, the right one too: tokens cannot be tried out. Safe for many threads.
class Access {
 public:
  using Clock = std::function<TimePoint()>;
  /// Told of refused attempts, those that are written down (see RefusalLog).
  using Refused = std::function<void(const std::string& line)>;

  Access(Credentials credentials, const AccessSettings& settings, Clock clock, Refused refused);

  /// `authorization` is the header's value, "Bearer …", empty without one; `what` names the attempt
  /// in the records.
  Ruling reading(const std::string& client, std::string_view authorization,
                 const std::string& what);
  Ruling command(const std::string& client, std::string_view authorization,
                 const std::string& what);

 private:
  Ruling identify(const std::string& client, std::string_view authorization, TimePoint now);
  Ruling recorded(Ruling ruling, const std::string& client, const std::string& what, TimePoint now);

  Credentials credentials_;
  AccessSettings settings_;
  Clock clock_;
  Refused refused_;
  std::mutex mutex_;
  RateLimit failures_;
  RateLimit commands_;
  RefusalLog refusals_;
};

}  // namespace biotomy::acquisition
