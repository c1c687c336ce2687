#include "acquisition/http/rate_limit.hpp"

#include <algorithm>

namespace biotomy::acquisition {
namespace {

constexpr std::chrono::milliseconds kMinute{60000};
constexpr std::size_t kMostClients = 1024;

}  // namespace

RateLimit::RateLimit(int at_once, std::chrono::milliseconds each)
    : share_(each), patience_(share_ * (at_once - 1)) {}

RateLimit RateLimit::per_minute(int times) {
  return {times, kMinute / times};
}

std::optional<std::chrono::milliseconds> RateLimit::take(const std::string& client, TimePoint now) {
  if (const auto wait = wait_of(client, now)) return wait;
  if (paid_until_.size() >= kMostClients && !paid_until_.contains(client)) forget_one(now);
  TimePoint& until = paid_until_[client];
  until = std::max(until, now) + share_;
  return std::nullopt;
}

std::optional<std::chrono::milliseconds> RateLimit::wait_of(const std::string& client,
                                                            TimePoint now) const {
  const auto found = paid_until_.find(client);
  if (found == paid_until_.end() || found->second <= now + patience_) return std::nullopt;
  return std::chrono::ceil<std::chrono::milliseconds>(found->second - patience_ - now);
}

void RateLimit::forget_one(TimePoint now) {
  std::erase_if(paid_until_, [now](const auto& entry) { return entry.second <= now; });
  if (paid_until_.size() < kMostClients) return;
  paid_until_.erase(
      std::min_element(paid_until_.begin(), paid_until_.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; }));
}

}  // namespace biotomy::acquisition
