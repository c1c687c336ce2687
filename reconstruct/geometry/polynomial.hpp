#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace biotomy::reconstruct {

/// Coefficients of a polynomial with N of them, that of x⁰ first.
template <std::size_t N>
using Polynomial = std::array<double, N>;

template <std::size_t N, std::size_t M>
Polynomial<N + M - 1> product(const Polynomial<N>& f, const Polynomial<M>& g) {
  Polynomial<N + M - 1> result{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < M; ++k) {
      result[i + k] += f[i] * g[k];
    }
  }
  return result;
}

/// f + factor·g
template <std::size_t N>
Polynomial<N> sum(Polynomial<N> f, double factor, const Polynomial<N>& g) {
  for (std::size_t i = 0; i < N; ++i) {
    f[i] += factor * g[i];
  }
  return f;
}

template <std::size_t N>
Polynomial<N - 1> derivative(const Polynomial<N>& f) {
  Polynomial<N - 1> result{};
  for (std::size_t i = 1; i < N; ++i) {
    result[i - 1] = static_cast<double>(i) * f[i];
  }
  return result;
}

/// The real roots from `first` to `last`, both within −1 … 1, in ascending order, as exact as the
/// polynomial can be computed. Where it turns without changing its sign, it counts as zero within
/// 10⁻¹³ of the sum of its coefficients: a double root is found in spite of rounding, once or
/// twice.
std::vector<double> roots_between(std::span<const double> coefficients, double first, double last);

}  // namespace biotomy::reconstruct
