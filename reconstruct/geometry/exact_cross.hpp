#pragma once

#include <cmath>

namespace biotomy::reconstruct {

/// The cross product a·d − b·c of (a, b) and (c, d), right to the last bit or two even where the
/// two products nearly cancel: Kahan's way, which finds the rounding error of one product by a
/// fused multiplication and takes it back.
inline double exact_cross(double a, double b, double c, double d) {
  const double product = b * c;
  const double error = std::fma(b, c, -product);
  return std::fma(a, d, -product) - error;
}

}  // namespace biotomy::reconstruct
