#include "acquisition/job/time_left.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kMost = 20;
constexpr std::size_t kFewest = 5;
constexpr double kDeviations = 2.0;

}  // namespace

void TimeLeft::begin(TimePoint now) {
  if (!began_) began_ = now;
}

void TimeLeft::end() {
  began_.reset();
  made_ = 0;
  interrupted();
}

void TimeLeft::layer_done(TimePoint now) {
  ++made_;
  newest_ = now;
  if (last_done_) {
    durations_.push_back(std::chrono::duration<double>(now - *last_done_).count());
    if (durations_.size() > kMost) durations_.pop_front();
  }
  last_done_ = now;
}

std::optional<double> TimeLeft::estimate(std::int64_t layers) const {
  if (!began_ || made_ == 0) return std::nullopt;
  const std::chrono::duration<double> taken = newest_ - *began_;
  return taken.count() / static_cast<double>(made_) * static_cast<double>(layers);
}

std::optional<TimeLeft::Range> TimeLeft::range(std::int64_t layers) const {
  const std::optional<double> middle = estimate(layers);
  if (!middle || durations_.size() < kFewest) return std::nullopt;
  const auto known = static_cast<double>(durations_.size());
  const double mean = std::accumulate(durations_.begin(), durations_.end(), 0.0) / known;
  double squares = 0.0;
  for (const double duration : durations_) squares += (duration - mean) * (duration - mean);
  const double variance = squares / (known - 1.0);
  // The layers to come scatter each by itself, and all of them with the mean that is known only
  // from a few.
  const auto n = static_cast<double>(layers);
  const double spread = kDeviations * std::sqrt(variance * (n + n * n / known));
  return Range{std::max(0.0, std::min(n * mean - spread, *middle)),
               std::max(n * mean + spread, *middle)};
}

}  // namespace biotomy::acquisition
