#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

/// A rig whose lens loses half the light in the corners.
RigPlan vignetted(const std::string& daemon_settings = "") {
  RigPlan plan;
  plan.layers = 2;
  plan.twin_camera_settings = "vignetting = 0.5\n";
  plan.daemon_settings = daemon_settings;
  return plan;
}

/// The same with a blank surface in view: of a block so wide that there is nothing but casting.
RigPlan vignetted_with_a_card() {
  RigPlan plan = vignetted();
  plan.twin_block_settings = "width = 100000\nheight = 100000\nspecks = 0\n";
  return plan;
}

Outcome calibrate(SimulatedRig& rig, const std::string& kind) {
  return run(
      {BIOTOMY_TOOL, "calibrate", kind, "--url", rig.url(), "--token-file", rig.folder() / "token"},
      rig.folder());
}

void do_job(SimulatedRig& rig) {
  const Outcome started = rig.rig("start");
  ASSERT_EQ(started.exit_code, 0) << started.errors;
  const Outcome watched = rig.rig("watch", seconds(200));
  ASSERT_EQ(watched.exit_code, 0) << watched.output << watched.errors;
}

/// How bright the last layer's corners are, of what they really are, relative to the middle.
double corners_to_middle(const SimulatedRig& rig) {
  const auto sample = reconstruct::SampleFolder::open(rig.sample());
  const int layer = rig.plan().layers;
  const cv::Mat image = reconstruct::read_layer_image(sample.layer_path(layer));
  const auto brightness = [&](const cv::Rect& part) {
    double seen = 0.0;
    double real = 0.0;
    for (int y = part.y; y < part.br().y; ++y) {
      for (int x = part.x; x < part.br().x; ++x) {
        seen += image.at<cv::Vec3b>(y, x)[1];
        real += rig.phantom()
                    .colour_at(x * rig.plan().pixel_um, y * rig.plan().pixel_um,
                               (layer - 1) * rig.plan().layer_thickness_um)
                    .g;
      }
    }
    return seen / real;
  };
  const int w = image.cols / 8;
  const int h = image.rows / 8;
  double corners = 0.0;
  for (const int x : {0, image.cols - w}) {
    for (const int y : {0, image.rows - h}) corners += 0.25 * brightness({x, y, w, h});
  }
  return corners / brightness({image.cols / 2 - w / 2, image.rows / 2 - h / 2, w, h});
}

TEST(Calibration, ByItsFlatFieldALayerIsEven) {
  SimulatedRig plain(vignetted());
  plain.start_daemon();
  do_job(plain);
  EXPECT_LT(corners_to_middle(plain), 0.65);

  SimulatedRig calibrated(vignetted_with_a_card());
  calibrated.start_daemon();
  EXPECT_THAT(calibrate(calibrated, "flat").errors, HasSubstr("acknowledge it first"));
  ASSERT_EQ(calibrated.rig("acknowledge").exit_code, 0);
  const std::filesystem::path folder = calibrated.folder() / "calibration";
  for (const char* kind : {"dark", "flat"}) {
    const Outcome recorded = calibrate(calibrated, kind);
    ASSERT_EQ(recorded.exit_code, 0) << recorded.errors;
    EXPECT_THAT(recorded.output, HasSubstr("of 16 frames"));
    EXPECT_TRUE(std::filesystem::exists(folder / (std::string(kind) + ".json")));
  }
  SimulatedRig rig(
      vignetted("[calibration]\nflat = true\ndark = true\nfolder = \"" + folder.string() + "\"\n"));
  rig.start_daemon();
  do_job(rig);
  EXPECT_NEAR(corners_to_middle(rig), 1.0, 0.03);
}

TEST(Calibration, ThatIsConfiguredAndMissingStopsTheJobAtItsStart) {
  SimulatedRig rig(vignetted("[calibration]\nflat = true\n"));
  rig.start_daemon();
  ASSERT_EQ(rig.rig("start").exit_code, 0);
  const Outcome watched = rig.rig("watch", seconds(60));
  EXPECT_EQ(watched.exit_code, 1);
  EXPECT_THAT(watched.errors, HasSubstr("there is no flat field in"));
  EXPECT_THAT(watched.errors, HasSubstr("biotomy calibrate flat"));
}

TEST(Calibration, OfWhiteTellsTheGains) {
  RigPlan plan = vignetted_with_a_card();
  plan.daemon_camera_settings = "red_gain = 1.25\n";
  SimulatedRig rig(plan);
  rig.start_daemon();
  ASSERT_EQ(rig.rig("acknowledge").exit_code, 0);
  const Outcome found = calibrate(rig, "white");
  ASSERT_EQ(found.exit_code, 0) << found.errors;
  EXPECT_THAT(found.output, HasSubstr("camera.red_gain = "));
  std::ifstream file(rig.folder() / "calibration" / "white.json");
  const auto record = nlohmann::json::parse(file);
  // What the casting lacks of grey, whatever gain it was seen with.
  const sim::Colour casting = rig.phantom().colour_at(800.0, 600.0, -100.0);
  EXPECT_NEAR(record.at("red_gain").get<double>(), casting.g / casting.r, 0.05);
  EXPECT_NEAR(record.at("blue_gain").get<double>(), casting.g / casting.b, 0.05);
}

TEST(Calibration, OfTheFocusFindsTheFaceSharpAndLeavesTheRigFitForAJob) {
  RigPlan plan;
  plan.layers = 2;
  SimulatedRig rig(plan);
  rig.start_daemon();
  ASSERT_EQ(rig.rig("acknowledge").exit_code, 0);
  const Outcome found = calibrate(rig, "focus");
  ASSERT_EQ(found.exit_code, 0) << found.errors;
  EXPECT_THAT(found.output, HasSubstr("set focus.start_um = "));
  std::ifstream file(rig.folder() / "calibration" / "focus.json");
  const auto record = nlohmann::json::parse(file);
  const nlohmann::json last = rig.witnessed("capture").back();
  EXPECT_NEAR(last.at("defocus_um").get<double>(), 0.0, 10.0);
  EXPECT_NEAR(last.at("column_um").get<double>(), record.at("plane_um").get<double>(), 5.0);
  EXPECT_TRUE(last.at("face_in_view").get<bool>());
  EXPECT_TRUE(rig.witnessed("grind_pass").empty());
  do_job(rig);
}

}  // namespace
}  // namespace biotomy::tests
