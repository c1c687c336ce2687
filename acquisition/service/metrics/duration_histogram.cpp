#include "acquisition/service/metrics/duration_histogram.hpp"

#include <algorithm>
#include <utility>

namespace biotomy::acquisition {

DurationHistogram::DurationHistogram(std::vector<double> bounds_s)
    : bounds_s_(std::move(bounds_s)), counts_(bounds_s_.size(), 0) {}

void DurationHistogram::add(std::chrono::duration<double> time) {
  const auto bound = std::lower_bound(bounds_s_.begin(), bounds_s_.end(), time.count());
  if (bound != bounds_s_.end()) ++counts_[static_cast<std::size_t>(bound - bounds_s_.begin())];
  ++count_;
  sum_s_ += time.count();
}

HistogramSample DurationHistogram::sample(MetricLabels labels) const {
  HistogramSample sample{std::move(labels), bounds_s_, counts_, count_, sum_s_};
  for (std::size_t i = 1; i < sample.counts.size(); ++i) sample.counts[i] += sample.counts[i - 1];
  return sample;
}

}  // namespace biotomy::acquisition
