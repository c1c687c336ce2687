#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "reconstruct/picture/image_file.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume.hpp"
#include "tests/integration/simulated_rig.hpp"

namespace biotomy::tests {
namespace {

using std::chrono::seconds;

/// Sections that are cut while the rig grinds.
class LiveSection : public testing::Test {
 protected:
  Outcome section(const std::string& normal, const std::string& through,
                  const std::filesystem::path& picture, const std::string& pixel) {
    return run({BIOTOMY_TOOL, "section", rig_.sample(), "--unit", "voxel", "--normal", normal,
                "--through", through, "--pixel", pixel, "-o", picture},
               rig_.folder());
  }

  SimulatedRig rig_{RigPlan{}};
};

TEST_F(LiveSection, ReachesTheNewestAcceptedLayerWhileTheVolumeGrows) {
  rig_.start_daemon();
  ASSERT_EQ(rig_.rig("start").exit_code, 0);
  const auto deadline = std::chrono::steady_clock::now() + seconds(150);
  int ahead_of_the_volume = 0;
  std::int64_t committed = 0;
  while (committed < rig_.plan().layers) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << rig_.status().dump(1);
    committed = rig_.status().at("committed");
    if (committed == 0) continue;
    const auto sample = reconstruct::SampleFolder::open(rig_.sample());
    const bool ahead = reconstruct::Volume::of_sample(sample).layers_present() < committed;

    const std::filesystem::path face = rig_.folder() / "face.png";
    const std::string depth = "0,0," + std::to_string(committed - 1);
    const Outcome flat = section("0,0,1", depth, face, "1");
    ASSERT_EQ(flat.exit_code, 0) << flat.errors;
    const cv::Mat expected = reconstruct::read_layer_image(sample.layer_path(committed));
    ASSERT_EQ(cv::norm(reconstruct::read_image_file(face), expected, cv::NORM_INF), 0.0)
        << "layer " << committed;

    // Upright and coarser than the voxels: all levels are read while the writer makes them anew.
    const Outcome upright = section("0,1,0", "0,60,0", rig_.folder() / "upright.png", "3");
    ASSERT_EQ(upright.exit_code, 0) << upright.errors;
    if (ahead) ++ahead_of_the_volume;
  }
  EXPECT_GT(ahead_of_the_volume, 0) << "the volume was never behind: nothing was tested";
}

}  // namespace
}  // namespace biotomy::tests
