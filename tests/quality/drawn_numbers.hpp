#pragma once

#include <cmath>
#include <cstdint>

#include "sim/phantom/gradient_noise.hpp"

namespace biotomy::tests {

/// Random numbers that are the same on every machine.
class DrawnNumbers {
 public:
  explicit DrawnNumbers(std::uint64_t seed) : seed_(seed) {}

  double between(double least, double most) {
    return least + (most - least) * static_cast<double>(sim::mixed_fraction(seed_, drawn_++));
  }

  /// Small numbers as often as large ones, by their ratio. `least` is positive.
  double between_ratios(double least, double most) {
    return std::exp(between(std::log(least), std::log(most)));
  }

  int below(int count) { return static_cast<int>(between(0.0, count)); }

  double sign() { return between(-1.0, 1.0) < 0.0 ? -1.0 : 1.0; }

 private:
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
};

}  // namespace biotomy::tests
