#include "tests/quality/roc.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace biotomy::tests {
namespace {

std::vector<double> sorted(std::vector<double> values) {
  std::ranges::sort(values);
  return values;
}

}  // namespace

double area_under_roc(const MetricValues& values) {
  if (values.good.empty() || values.bad.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> good = sorted(values.good);
  double right = 0.0;
  for (const double bad : values.bad) {
    const auto [first, last] = std::equal_range(good.begin(), good.end(), bad);
    const double below = static_cast<double>(first - good.begin());
    const double above = static_cast<double>(good.end() - last);
    right += (values.low_is_bad ? above : below) + 0.5 * static_cast<double>(last - first);
  }
  return right / static_cast<double>(good.size()) / static_cast<double>(values.bad.size());
}

double detection_at(const MetricValues& values, double false_alarms) {
  if (values.good.empty() || values.bad.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double sign = values.low_is_bad ? -1.0 : 1.0;
  std::vector<double> good = values.good;
  for (double& value : good) value *= sign;
  std::ranges::sort(good, std::greater<>());
  // The limit is the worst good value that must pass.
  const auto rejected =
      static_cast<std::size_t>(std::floor(false_alarms * static_cast<double>(good.size()) + 1e-9));
  const double limit = good[std::min(rejected, good.size() - 1)];
  const auto detected =
      std::ranges::count_if(values.bad, [&](double value) { return sign * value > limit; });
  return static_cast<double>(detected) / static_cast<double>(values.bad.size());
}

}  // namespace biotomy::tests
