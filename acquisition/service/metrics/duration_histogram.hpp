#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "acquisition/service/metrics/metric_family.hpp"

namespace biotomy::acquisition {

/// How often something took how long, by bounds that are fixed. One thread uses it.
class DurationHistogram {
 public:
  /// Upper bounds in seconds, growing.
  explicit DurationHistogram(std::vector<double> bounds_s);

  void add(std::chrono::duration<double> time);

  HistogramSample sample(MetricLabels labels) const;

 private:
  std::vector<double> bounds_s_;
  std::vector<std::uint64_t> counts_;  ///< of each bound alone
  std::uint64_t count_ = 0;
  double sum_s_ = 0.0;
};

}  // namespace biotomy::acquisition
