#include "acquisition/focus/autofocus.hpp"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace biotomy::acquisition {
namespace {

constexpr bridge::AxisLimits kColumn{{0.0}, {10000.0}};

/// A bell around `peak`, 150 µm wide.
double bell(double column, double peak) {
  const double distance = (column - peak) / 150.0;
  return 0.1 + std::exp(-0.5 * distance * distance);
}

/// Runs the search to its end; the column goes where it is told.
Autofocus search(double predicted, const std::function<double(double)>& sharpness,
                 bridge::AxisLimits column = kColumn, const FocusSettings& settings = {}) {
  Autofocus focus(settings, {predicted}, column);
  for (int i = 0; i < 10000; ++i) {
    const auto request = focus.next();
    if (!request) return focus;
    if (request->measure) {
      focus.measured(sharpness(request->column.value));
    } else {
      focus.arrived();
    }
  }
  ADD_FAILURE() << "the search does not end";
  return focus;
}

TEST(Autofocus, FindsThePeakBetweenItsPoints) {
  const Autofocus focus = search(5000.0, [](double column) { return bell(column, 5037.0); });
  ASSERT_TRUE(focus.best());
  EXPECT_NEAR(focus.best()->column.value, 5037.0, 1.0);
  EXPECT_EQ(focus.points().size(), 11U);
}

TEST(Autofocus, MovesTheSweepOnUntilThePeakIsInside) {
  for (const double peak : {4500.0, 5500.0}) {
    const Autofocus focus = search(5000.0, [&](double column) { return bell(column, peak); });
    ASSERT_TRUE(focus.best()) << peak;
    EXPECT_NEAR(focus.best()->column.value, peak, 1.0);
    EXPECT_GT(focus.points().size(), 11U);
  }
}

TEST(Autofocus, GivesUpAPeakThatIsBeyondTheLimitsOfTheColumn) {
  const Autofocus focus = search(100.0, [](double column) { return bell(column, -300.0); });
  EXPECT_FALSE(focus.best());
}

TEST(Autofocus, GivesUpAfterItsShifts) {
  FocusSettings settings;
  settings.shifts = 2;
  const Autofocus focus = search(
      5000.0, [](double column) { return bell(column, 9000.0) + column * 1e-6; }, kColumn,
      settings);
  EXPECT_FALSE(focus.best());
  EXPECT_EQ(focus.points().size(), 33U);
}

TEST(Autofocus, ApproachesEveryMeasurementFromBelow) {
  FocusSettings settings;
  Autofocus focus(settings, {5000.0}, kColumn);
  double last = 1e9;
  while (const auto request = focus.next()) {
    if (request->measure) {
      EXPECT_GT(request->column.value, last);
      focus.measured(bell(request->column.value, 4800.0));
    } else {
      focus.arrived();
    }
    last = request->column.value;
  }
  EXPECT_TRUE(focus.best());
}

TEST(Autofocus, NeverLeavesTheLimitsOfTheColumn) {
  const bridge::AxisLimits narrow{{4990.0}, {5060.0}};
  FocusSettings settings;
  settings.points = 3;
  Autofocus focus(settings, {5000.0}, narrow);
  while (const auto request = focus.next()) {
    EXPECT_GE(request->column, narrow.minimum);
    EXPECT_LE(request->column, narrow.maximum);
    if (request->measure) {
      focus.measured(bell(request->column.value, 5300.0));
    } else {
      focus.arrived();
    }
  }
}

TEST(ParabolaPeak, IsTheVertexOfTheParabola) {
  const auto parabola = [](double x) { return 7.0 - 0.25 * (x - 103.0) * (x - 103.0); };
  const Autofocus::Point peak = parabola_peak({{90.0}, parabola(90.0)}, {{100.0}, parabola(100.0)},
                                              {{110.0}, parabola(110.0)});
  EXPECT_NEAR(peak.column.value, 103.0, 1e-9);
  EXPECT_NEAR(peak.sharpness, 7.0, 1e-9);
}

}  // namespace
}  // namespace biotomy::acquisition
