#include "reconstruct/geometry/polynomial.hpp"

#include <cmath>

namespace biotomy::reconstruct {
namespace {

constexpr double kNoHeight = 1e-13;

double value(std::span<const double> coefficients, double x) {
  double sum = 0.0;
  for (std::size_t i = coefficients.size(); i-- > 0;) {
    sum = sum * x + coefficients[i];
  }
  return sum;
}

// The signs at both ends differ. Halving never fails, and costs less than the care that a faster
// method takes: both ends lie within −1 … 1, so that 60 times leave less than rounding does.
double bisect(std::span<const double> coefficients, double low, double high) {
  constexpr int kHalvings = 60;
  const bool rising = value(coefficients, low) < 0.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    ((value(coefficients, middle) < 0.0) == rising ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

// Between two neighbouring turning points there is at most one root.
std::vector<double> roots_between(std::span<const double> coefficients, double first, double last) {
  if (coefficients.size() < 2) {
    return {};
  }
  std::vector<double> slope;
  double size = std::abs(coefficients[0]);
  for (std::size_t i = 1; i < coefficients.size(); ++i) {
    slope.push_back(static_cast<double>(i) * coefficients[i]);
    size += std::abs(coefficients[i]);
  }
  std::vector<double> stops = roots_between(slope, first, last);
  stops.push_back(last);

  std::vector<double> roots;
  double low = first;
  for (const double high : stops) {
    const double at_high = value(coefficients, high);
    if (std::signbit(value(coefficients, low)) != std::signbit(at_high)) {
      roots.push_back(bisect(coefficients, low, high));
    } else if (std::abs(at_high) <= kNoHeight * size) {
      roots.push_back(high);
    }
    low = high;
  }
  return roots;
}

}  // namespace biotomy::reconstruct
