#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/integration/child_process.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

/// A stack of real photographs, what is between its voxels, and a layer to look at.
struct Stack {
  const char* folder;
  const char* spacing;
  int layer;  ///< from 0
};

class RealPhotographs : public testing::TestWithParam<Stack> {};

TEST_P(RealPhotographs, AreImportedAndALayerCutOutIsThatPhotograph) {
  const fs::path images = fs::path(BIOTOMY_SHARED) / "data" / GetParam().folder;
  if (!fs::is_directory(images)) {
    GTEST_SKIP() << "there are no photographs in " << images
                 << "; the test is for those who have them beside the checkout";
  }
  const TemporaryFolder folder;
  const fs::path sample = folder / "sample";
  const Outcome imported =
      run({BIOTOMY_TOOL, "import", images, "--spacing", GetParam().spacing, "-o", sample},
          folder.path());
  ASSERT_EQ(imported.exit_code, 0) << imported.errors;

  const fs::path picture = folder / "layer.png";
  const Outcome cut =
      run({BIOTOMY_TOOL, "section", sample, "--normal", "0,0,1", "--through",
           "0,0," + std::to_string(GetParam().layer), "--unit", "voxel", "-o", picture},
          folder.path());
  ASSERT_EQ(cut.exit_code, 0) << cut.errors;

  std::string number = std::to_string(GetParam().layer);
  number.insert(0, 4 - number.size(), '0');
  const cv::Mat photograph = cv::imread(images / (number + ".png"), cv::IMREAD_COLOR);
  const cv::Mat layer = cv::imread(picture, cv::IMREAD_COLOR);
  ASSERT_EQ(layer.size(), photograph.size());
  EXPECT_EQ(cv::norm(layer, photograph, cv::NORM_INF), 0.0);
}

INSTANTIATE_TEST_SUITE_P(, RealPhotographs,
                         testing::Values(Stack{"vhp-male-head-rgb", "1320,1320,5000", 33},
                                         Stack{"focus-pcb-rgb", "10,10,20", 4},
                                         Stack{"vhp-ct-head-grey", "500,500,1000", 100}),
                         [](const auto& stack) {
                           std::string name = stack.param.folder;
                           for (char& c : name) {
                             if (c == '-') c = '_';
                           }
                           return name;
                         });

TEST(RealFocusSweep, IsSharpestWhereItsNotesSay) {
  const fs::path images = fs::path(BIOTOMY_SHARED) / "data" / "focus-pcb-rgb";
  if (!fs::is_directory(images)) {
    GTEST_SKIP() << "there are no photographs in " << images
                 << "; the test is for those who have them beside the checkout";
  }
  const TemporaryFolder folder;
  const Outcome ranked = run({BIOTOMY_TOOL, "qc", "--sweep", images, "--json"}, folder.path());
  ASSERT_EQ(ranked.exit_code, 0) << ranked.errors;
  const auto document = nlohmann::json::parse(ranked.output);
  EXPECT_EQ(document.at("sharpest"), "0004.png") << ranked.output;
  EXPECT_TRUE(document.at("certain").get<bool>());
  for (const std::size_t blurred : {7U, 8U, 9U}) {
    EXPECT_LT(document.at("frames").at(blurred).at("focus").get<double>(), 0.1) << blurred;
  }
}

}  // namespace
}  // namespace biotomy::tests
