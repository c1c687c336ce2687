#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

namespace biotomy::acquisition {

/// How often each client may do something: so many times at once, then again and again after equal
/// times (a token bucket). The number of clients that are remembered is bounded; who was not seen
/// for longest is forgotten first. One thread uses it.
class RateLimit {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  RateLimit(int at_once, std::chrono::milliseconds each);

  /// So many times at once, then again after equal shares of a minute.
  static RateLimit per_minute(int times);

  /// Counts one more; nothing when it is allowed, else after how long it will be.
  std::optional<std::chrono::milliseconds> take(const std::string& client, TimePoint now);

  /// The same question without counting.
  std::optional<std::chrono::milliseconds> wait_of(const std::string& client, TimePoint now) const;

 private:
  void forget_one(TimePoint now);

  std::chrono::milliseconds share_;              ///< until it may be done once more
  std::chrono::milliseconds patience_;           ///< all shares but the last
  std::map<std::string, TimePoint> paid_until_;  ///< when the client's bucket is full again
};

}  // namespace biotomy::acquisition
