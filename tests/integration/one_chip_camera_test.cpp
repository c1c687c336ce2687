#include <string>

#include <gmock/gmock.h>

#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

// Colours interpolated from a mosaic leave noise that is not white. The first layer's focus search
// tells it, the daemon notes it with the layer, and whoever judges the layers again knows it too.
TEST(OneChipCamera, DoesAJobWhoseNoiseIsLearntAndNoted) {
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
  EXPECT_THAT(judged.output, HasSubstr("noise_fine_light"));
}

}  // namespace
}  // namespace biotomy::tests
