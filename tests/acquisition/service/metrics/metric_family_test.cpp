#include "acquisition/service/metrics/metric_family.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "acquisition/service/metrics/duration_histogram.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using std::chrono::milliseconds;

TEST(Exposition, WritesFamiliesAsPrometheusReadsThem) {
  const std::vector<MetricFamily> families = {
      {"a_total", MetricType::counter, "How many.", {{{{"reason", "blurred"}}, 3.0}, {{}, 0.5}}},
      {"b_celsius", MetricType::gauge, "How cold.", {}}};
  EXPECT_EQ(exposition(families),
            "# HELP a_total How many.\n# TYPE a_total counter\n"
            "a_total{reason=\"blurred\"} 3\na_total 0.5\n"
            "# HELP b_celsius How cold.\n# TYPE b_celsius gauge\n");
}

TEST(Exposition, WritesOutWhatWouldEndAText) {
  const std::vector<MetricFamily> families = {
      {"a", MetricType::gauge, "back\\slash\nline", {{{{"x", "say \"\\\"\n"}, {"y", "2"}}, 1.0}}}};
  EXPECT_EQ(exposition(families),
            "# HELP a back\\\\slash\\nline\n# TYPE a gauge\n"
            "a{x=\"say \\\"\\\\\\\"\\n\",y=\"2\"} 1\n");
}

TEST(Exposition, WritesNumbersThatAreNone) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<MetricFamily> families = {
      {"a", MetricType::gauge, "x", {{{}, kInfinity}, {{}, -kInfinity}, {{}, std::nan("")}}}};
  EXPECT_EQ(exposition(families), "# HELP a x\n# TYPE a gauge\na +Inf\na -Inf\na NaN\n");
}

TEST(Exposition, WritesAHistogramWithCumulativeBuckets) {
  DurationHistogram times({0.1, 0.5, 1.0});
  for (const int ms : {50, 100, 300, 700, 5000}) times.add(milliseconds(ms));
  const std::vector<MetricFamily> families = {
      {"t_seconds", MetricType::histogram, "x", {}, {times.sample({{"step", "storing"}})}}};
  EXPECT_EQ(exposition(families),
            "# HELP t_seconds x\n# TYPE t_seconds histogram\n"
            "t_seconds_bucket{step=\"storing\",le=\"0.1\"} 2\n"
            "t_seconds_bucket{step=\"storing\",le=\"0.5\"} 3\n"
            "t_seconds_bucket{step=\"storing\",le=\"1\"} 4\n"
            "t_seconds_bucket{step=\"storing\",le=\"+Inf\"} 5\n"
            "t_seconds_sum{step=\"storing\"} 6.15\n"
            "t_seconds_count{step=\"storing\"} 5\n");
}

}  // namespace
}  // namespace biotomy::tests
