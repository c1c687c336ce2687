#pragma once

#include <algorithm>
#include <vector>

namespace biotomy::acquisition {

struct Weighted {
  double value = 0.0;
  double weight = 0.0;
};

/// Standard error of a median over that of the mean, of normally scattering values: sqrt(pi / 2).
inline constexpr double kMedianOfMean = 1.2533;

/// The value with half of the weight below it. There is at least one value.
inline double weighted_median(std::vector<Weighted> values) {
  std::sort(values.begin(), values.end(),
            [](const Weighted& left, const Weighted& right) { return left.value < right.value; });
  double half = 0.0;
  for (const Weighted& value : values) half += 0.5 * value.weight;
  for (const Weighted& value : values) {
    half -= value.weight;
    if (half <= 0.0) return value.value;
  }
  return values.back().value;
}

}  // namespace biotomy::acquisition
