#include "acquisition/service/liveness.hpp"

#include <utility>

namespace biotomy::acquisition {

Liveness::Liveness(BusySince worker_busy_since, std::chrono::milliseconds worker_limit)
    : worker_busy_since_(std::move(worker_busy_since)), worker_limit_(worker_limit) {}

bool Liveness::take_progress(TimePoint now) {
  const std::uint64_t ticks = ticks_;
  if (ticks == taken_ || complaint(now)) return false;
  taken_ = ticks;
  return true;
}

std::optional<std::string> Liveness::complaint(TimePoint now) const {
  const std::optional<TimePoint> busy_since = worker_busy_since_();
  if (!busy_since || now - *busy_since <= worker_limit_) return std::nullopt;
  return "the thread for camera and disk has been at one task for more than " +
         std::to_string(worker_limit_.count()) + " ms: it hangs";
}

}  // namespace biotomy::acquisition
