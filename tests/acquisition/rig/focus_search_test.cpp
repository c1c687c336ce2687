#include "acquisition/rig/focus_search.hpp"

#include <gtest/gtest.h>

#include "tests/acquisition/fake_rig.hpp"
#include "tests/acquisition/quality/phantom_photographer.hpp"

namespace biotomy::tests {
namespace {

using namespace acquisition;
using bridge::Micrometres;

constexpr Micrometres kSharp{5000.0};

/// Stands where it was told to at once.
struct ObedientActuator : FocusActuator {
  Micrometres position{};

  const char* name() const override { return "column"; }
  bridge::AxisLimits limits() const override { return {Micrometres{0.0}, Micrometres{10000.0}}; }
  void move_to(Micrometres target, TimePoint) override { position = target; }
  bool settled(const bridge::StageStatus&, TimePoint) override { return true; }
  std::optional<Micrometres> reported(const bridge::StageStatus&) const override {
    return position;
  }
  std::string describe(Micrometres) const override { return ""; }
};

/// Sees the specimen, as sharp as the actuator lets it.
struct PhantomCamera : bridge::Camera {
  explicit PhantomCamera(const ObedientActuator& moved) : actuator(moved) {}

  bridge::CameraDescription describe() override { return {}; }
  void apply(const bridge::CameraSettings&) override {}
  bridge::Frame capture(std::chrono::milliseconds) override {
    return {.image = photographer.photograph(100.0, 0.0, 0.0, (actuator.position - kSharp).value)};
  }

  const ObedientActuator& actuator;
  PhantomPhotographer photographer{{.width = 320, .height = 240}};
};

TEST(FocusSearch, MeasuresItsFramesByTheNoiseOfItsPlan) {
  CameraNoise noise;
  noise.bands[DetailBand::fine] = {.dark = 1e-6, .light = 0.0};
  ObedientActuator actuator;
  PhantomCamera camera(actuator);
  InlineWorker worker;
  const JobSettings settings;
  const SearchPlan plan{
      .predicted = kSharp, .step = settings.focus.step, .largest_change = {}, .noise = noise};
  FocusSearch search(settings, plan, {actuator, camera, worker}, {});
  while (!search.poll({}, {})) continue;
  ASSERT_TRUE(search.found()) << search.why_not();
  for (const TileMeasures& tile : search.found()->measures->tiles) {
    EXPECT_EQ(tile.noise[DetailBand::fine], 1e-6);
  }
}

}  // namespace
}  // namespace biotomy::tests
