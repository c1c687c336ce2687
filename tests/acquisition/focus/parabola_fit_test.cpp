#include "acquisition/focus/parabola_fit.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

std::vector<MeasuredPoint> parabola(double vertex) {
  std::vector<MeasuredPoint> points;
  for (double x = 0.0; x < 5.0; x += 1.0) {
    points.push_back({.x = x, .y = 7.0 - 0.25 * (x - vertex) * (x - vertex), .error = 0.01});
  }
  return points;
}

TEST(ParabolaFit, IsTheParabolaThroughItsPoints) {
  const auto fit = fit_parabola(parabola(2.3));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->vertex, 2.3, 1e-9);
  EXPECT_NEAR(fit->top, 7.0, 1e-9);
  EXPECT_NEAR(fit->curvature, 0.5, 1e-9);
  EXPECT_NEAR(fit->residual, 0.0, 1e-9);
}

TEST(ParabolaFit, KnowsHowFarNoiseMovesTheVertex) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 0.01);
  double squares = 0.0;
  double expected = 0.0;
  constexpr int kRuns = 2000;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<MeasuredPoint> points = parabola(2.6);
    for (MeasuredPoint& point : points) point.y += noise(random);
    const auto fit = fit_parabola(points);
    ASSERT_TRUE(fit);
    squares += std::pow(fit->vertex - 2.6, 2);
    expected += fit->vertex_error;
  }
  EXPECT_NEAR(std::sqrt(squares / kRuns) / (expected / kRuns), 1.0, 0.1);
}

TEST(ParabolaFit, ListensToPointsByTheirWeight) {
  std::vector<MeasuredPoint> points = parabola(2.3);
  points[0].y = 0.0;
  points[0].weight = 1e-9;
  const auto fit = fit_parabola(points);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->vertex, 2.3, 1e-3);
}

TEST(ParabolaFit, IsNothingForAValleyALineOrTooFewPoints) {
  std::vector<MeasuredPoint> valley = parabola(2.0);
  for (MeasuredPoint& point : valley) point.y = -point.y;
  EXPECT_FALSE(fit_parabola(valley));
  std::vector<MeasuredPoint> line = parabola(2.0);
  for (MeasuredPoint& point : line) point.y = point.x;
  EXPECT_FALSE(fit_parabola(line));
  EXPECT_FALSE(fit_parabola(std::vector(3, MeasuredPoint{})));
}

}  // namespace
}  // namespace biotomy::acquisition
