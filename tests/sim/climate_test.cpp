#include "sim/physics/climate.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace biotomy::sim {
namespace {

struct Weather {
  Climate climate;
  double warmest_c = -100;
  double coldest_c = 100;

  explicit Weather(const ClimateSettings& settings = {}) : climate(settings) {}
  void run(double seconds, bool cuts = false, double failed_s = 0) {
    warmest_c = -100;
    coldest_c = 100;
    for (double t = 0; t < seconds; t += 0.05) {
      climate.advance(0.05, cuts, failed_s);
      warmest_c = std::max(warmest_c, climate.chamber_c());
      coldest_c = std::min(coldest_c, climate.chamber_c());
    }
  }
};

TEST(Climate, GoesUpAndDownWithItsCooler) {
  Weather weather({.chamber_band_c = 0.5});
  weather.run(600);
  EXPECT_NEAR(weather.warmest_c, -21.5, 0.05);
  EXPECT_NEAR(weather.coldest_c, -22.5, 0.05);
  EXPECT_NEAR(weather.climate.block_c(), -30, 0.5);
}

TEST(Climate, KeepsItsTemperatureExactlyWithACoolerWithoutABand) {
  Weather weather;
  weather.run(100);
  EXPECT_NEAR(weather.climate.chamber_c(), -22, 0.01);
  EXPECT_NEAR(weather.climate.block_c(), -30, 0.01);
}

TEST(Climate, WarmsTheBlockWhileTheWheelCutsAndCoolsItAfterwards) {
  Weather weather;
  weather.run(60, true);
  const double warmed_c = weather.climate.block_c();
  EXPECT_GT(warmed_c, -29.5);
  weather.run(300);
  EXPECT_NEAR(weather.climate.block_c(), -30, 0.05);
}

TEST(Climate, LeavesItsWindowWithoutItsCoolerAndComesBackWithIt) {
  Weather weather;
  weather.run(400, false, 200);
  EXPECT_GT(weather.climate.chamber_c(), 5);
  EXPECT_GT(weather.climate.block_c(), -5);
  weather.run(3000);
  EXPECT_NEAR(weather.climate.block_c(), -30, 0.1);
}

}  // namespace
}  // namespace biotomy::sim
