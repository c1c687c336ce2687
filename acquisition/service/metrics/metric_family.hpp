#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace biotomy::acquisition {

enum class MetricType { counter, gauge, histogram };

const char* to_string(MetricType type);

/// Names and values that tell the samples of one family apart.
using MetricLabels = std::vector<std::pair<std::string, std::string>>;

struct MetricSample {
  MetricLabels labels;
  double value = 0.0;
};

/// How often something took how long: for each upper bound, in growing order, how many were not
/// above it.
struct HistogramSample {
  MetricLabels labels;
  std::vector<double> bounds;
  std::vector<std::uint64_t> counts;  ///< cumulative, of each bound
  std::uint64_t count = 0;
  double sum = 0.0;
};

/// One metric as Prometheus knows it. Names carry their base unit, counters end in _total.
struct MetricFamily {
  std::string name;
  MetricType type = MetricType::gauge;
  std::string help;
  std::vector<MetricSample> samples{};
  std::vector<HistogramSample> histograms{};
};

/// Prometheus' text format 0.0.4. A family without samples is announced all the same.
std::string exposition(const std::vector<MetricFamily>& families);

}  // namespace biotomy::acquisition
