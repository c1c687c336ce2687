#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "reconstruct/store/volume_writer.hpp"
#include "tests/integration/child_process.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kBuildLimit(240);

/// The library as another project meets it: installed, found and linked, by the example in docs/.
/// The install tree and the example's build stay in the tests' build folder, for looking at.
class Library : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(tree_);
    fs::create_directories(tree_);
    expect_done({BIOTOMY_CMAKE, "--install", BIOTOMY_BUILD, "--component", "development",
                 "--prefix", tree_ / "installed"});
    expect_done({BIOTOMY_CMAKE, "-S", BIOTOMY_EXAMPLE, "-G", "Ninja", "-B", tree_ / "build",
                 "-DCMAKE_BUILD_TYPE=Release",
                 std::string("-DCMAKE_CXX_COMPILER=") + BIOTOMY_COMPILER,
                 "-DCMAKE_PREFIX_PATH=" + (tree_ / "installed").string()});
    expect_done({BIOTOMY_CMAKE, "--build", tree_ / "build"});
  }

  void expect_done(const std::vector<std::string>& command) {
    const Outcome outcome = run(command, tree_, kBuildLimit);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output << outcome.errors;
  }

  fs::path sample() {
    const fs::path images = folder_ / "images";
    fs::create_directory(images);
    for (int i = 1; i <= 20; ++i) {
      cv::Mat image(48, 64, CV_8UC3);
      cv::randu(image, 0, 256);
      cv::imwrite(images / (std::to_string(i) + ".png"), image);
    }
    expect_done(
        {BIOTOMY_TOOL, "import", images, "--spacing", "10,10,20", "-o", folder_ / "sample"});
    return folder_ / "sample";
  }

  /// A sample in the middle of its job: of its eleven layers the volume has eight.
  fs::path growing_sample() {
    using namespace reconstruct;
    const SampleFolder sample =
        sample_with_layers(folder_ / "growing", {64, 48, 20}, 8, 8, {10, 10, 20});
    VolumeWriter(sample, VolumeLayout()).append(8, false);
    add_layers(sample, 9, 11);
    return sample.path();
  }

  void expect_the_tools_section(const fs::path& sample, const std::string& points) {
    const Outcome cut =
        run({tree_ / "build" / "section", sample, points, folder_ / "example.png"}, folder_.path());
    ASSERT_EQ(cut.exit_code, 0) << cut.errors;
    EXPECT_NE(cut.output.find("pixels of 10 um"), std::string::npos) << cut.output;
    expect_done({BIOTOMY_TOOL, "section", sample, "--points", points, "--theta", "inscribed", "-o",
                 folder_ / "tool.png"});
    const cv::Mat example = cv::imread(folder_ / "example.png");
    const cv::Mat tool = cv::imread(folder_ / "tool.png");
    ASSERT_FALSE(example.empty());
    ASSERT_EQ(example.size(), tool.size());
    EXPECT_EQ(cv::norm(example, tool, cv::NORM_INF), 0.0);
  }

  const fs::path tree_ = BIOTOMY_LIBRARY_TREE;
  TemporaryFolder folder_;
};

TEST_F(Library, AnExampleThatIsBuiltAgainstItCutsTheSectionThatTheToolCuts) {
  const fs::path program = tree_ / "build" / "section";
  const std::string points = "300,0,100 0,250,100 630,470,280";
  const fs::path cut_sample = sample();
  expect_the_tools_section(cut_sample, points);
  expect_the_tools_section(growing_sample(), "0,0,100 630,0,200 0,470,160");

  EXPECT_EQ(run({program, cut_sample, "0,0,0 1,1,1 2,2,2", folder_ / "none.png"}, folder_.path())
                .exit_code,
            2);
  EXPECT_EQ(
      run({program, folder_ / "nowhere", points, folder_ / "none.png"}, folder_.path()).exit_code,
      1);
}

}  // namespace
}  // namespace biotomy::tests
