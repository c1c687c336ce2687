#include "reconstruct/geometry/polynomial.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gmock/gmock.h>

namespace biotomy::reconstruct {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(Polynomial, IsMultipliedAddedAndDerived) {
  const Polynomial<2> f{1.0, 2.0};        // 1 + 2x
  const Polynomial<3> g{3.0, -1.0, 4.0};  // 3 − x + 4x²
  EXPECT_EQ(product(f, g), (Polynomial<4>{3.0, 5.0, 2.0, 8.0}));
  EXPECT_EQ(sum(g, 2.0, {1.0, 1.0, 1.0}), (Polynomial<3>{5.0, 1.0, 6.0}));
  EXPECT_EQ(derivative(g), (Polynomial<2>{-1.0, 8.0}));
}

TEST(PolynomialRoots, AreThoseOfItsFactors) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-0.99, 0.99);
  for (int i = 0; i < 1000; ++i) {
    std::vector<double> expected{place(random), place(random), place(random), place(random)};
    std::sort(expected.begin(), expected.end());
    const auto factor = [&](std::size_t k) { return Polynomial<2>{-expected[k], 1.0}; };
    const auto f = product(product(factor(0), factor(1)), product(factor(2), factor(3)));
    bool apart = true;
    for (std::size_t k = 1; k < 4; ++k) {
      apart = apart && expected[k] - expected[k - 1] > 1e-3;
    }
    if (!apart) {
      continue;
    }
    EXPECT_THAT(roots_between(f, -1.0, 1.0), testing::Pointwise(DoubleNear(1e-6), expected));
  }
}

TEST(PolynomialRoots, OutsideTheIntervalAreLeftOut) {
  const Polynomial<3> f{-0.25, 0.0, 1.0};  // ±0.5
  EXPECT_THAT(roots_between(f, 0.0, 1.0), ElementsAre(DoubleNear(0.5, 1e-15)));
  EXPECT_THAT(roots_between(f, -0.4, 0.4), IsEmpty());
}

TEST(PolynomialRoots, AreNoneOfAConstantOrAPositivePolynomial) {
  EXPECT_THAT(roots_between(Polynomial<1>{3.0}, -1.0, 1.0), IsEmpty());
  EXPECT_THAT(roots_between(Polynomial<3>{1.0, 0.0, 1.0}, -1.0, 1.0), IsEmpty());
}

TEST(PolynomialRoots, WithoutAChangeOfSignAreFound) {
  const Polynomial<3> f{0.09, -0.6, 1.0};  // (x − 0.3)², rounded
  const std::vector<double> roots = roots_between(f, -1.0, 1.0);
  EXPECT_THAT(roots, testing::AllOf(testing::Not(IsEmpty()), testing::Each(DoubleNear(0.3, 1e-7))));
}

}  // namespace
}  // namespace biotomy::reconstruct
