#include <map>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::seconds;

/// The values of the metrics that the journal has of a layer's accepted attempt, as `qc` tells it.
std::map<std::string, double> journalled(const std::string& report, std::size_t layer) {
  std::map<std::string, double> values;
  const nlohmann::json attempts =
      nlohmann::json::parse(report).at("frames").at(layer - 1).at("journal");
  for (const nlohmann::json& metric : attempts.back().at("metrics")) {
    values[metric.at("name")] = metric.at("value");
  }
  return values;
}

// Colours interpolated from a mosaic leave noise that is not white. The first layer's focus search
// tells it, and the daemon notes it with the layer.
TEST(OneChipCamera, DoesAJobWhoseNoiseIsNotedAndIsNotWhite) {
  RigPlan plan;
  plan.width = 320;
  plan.height = 240;
  plan.layers = 5;
  plan.twin_camera_settings = "mosaic = true\n";
  SimulatedRig rig(plan);
  rig.start_daemon();
  const Outcome started = rig.rig("start");
  ASSERT_EQ(started.exit_code, 0) << started.errors;
  const Outcome watched = rig.rig("watch", seconds(200));
  ASSERT_EQ(watched.exit_code, 0) << watched.output << watched.errors;

  const Outcome judged =
      run({BIOTOMY_TOOL, "qc", "--sample", rig.sample(), "--strict", "--json"}, rig.folder());
  EXPECT_EQ(judged.exit_code, 0) << judged.output << judged.errors;
  const std::map<std::string, double> noted = journalled(judged.output, 1);
  ASSERT_TRUE(noted.contains("noise_fine_light")) << judged.output;
  constexpr double kWhite = 3.0 / 16.0 / 6.0;  // what white noise adds to gradient and curvature
  const auto at_half = [&](const std::string& band) {
    return noted.at("noise_" + band + "_dark") + 0.5 * noted.at("noise_" + band + "_light");
  };
  EXPECT_GT(at_half("fine") / at_half("curvature"), 2.0 * kWhite);
}

}  // namespace
}  // namespace biotomy::tests
