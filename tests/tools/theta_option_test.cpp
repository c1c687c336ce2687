#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "reconstruct/errors.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"
#include "tools/command.hpp"

namespace biotomy::tools {
namespace {

using reconstruct::InvalidRequest;
using reconstruct::message_of;
using testing::HasSubstr;

const cv::Vec3b kNoTissue{255, 0, 255};  // B, G, R

/// Cuts a white sample of 60 × 40 × 30 voxels of 10 × 10 × 20 µm with a background that is not
/// white.
class ThetaOption : public testing::Test {
 protected:
  ThetaOption() {
    const std::string images = (folder_.path() / "images").string();
    std::filesystem::create_directory(images);
    for (int i = 0; i < 30; ++i) {
      reconstruct::save_rgb(images + "/" + std::to_string(i) + ".png",
                            cv::Mat(40, 60, CV_8UC3, cv::Scalar(255, 255, 255)));
    }
    run({"import", images, "--spacing", "10,10,20", "-o", sample_});
  }

  static void run(std::vector<std::string> arguments) {
    CLI::App app;
    add_import_command(app);
    add_section_command(app);
    add_series_command(app);
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    app.parse(arguments);
  }

  cv::Mat section(const std::string& theta, const std::string& unit = "um") {
    const std::string picture = (folder_.path() / "section.png").string();
    const std::string through = unit == "voxel" ? "30,20,15" : "300,200,300";
    run({"section", sample_, "--normal", "1,2,1.5", "--through", through, "--unit", unit,
         "--background", "255,0,255", "--theta", theta, "-o", picture});
    return cv::imread(picture);
  }

  static bool has_background(const cv::Mat& image) {
    return std::any_of(image.begin<cv::Vec3b>(), image.end<cv::Vec3b>(),
                       [](const cv::Vec3b& pixel) { return pixel == kNoTissue; });
  }

  tests::TemporaryFolder folder_;
  std::string sample_ = (folder_.path() / "sample").string();
};

TEST_F(ThetaOption, OfInscribedRectanglesLeavesNoBackgroundInThePicture) {
  EXPECT_TRUE(has_background(section("bounding")));
  for (const char* theta : {"inscribed", "inscribed-any", "edge:0", "edge:1", "edge:2", "edge:3"}) {
    const cv::Mat image = section(theta);
    EXPECT_GT(image.total(), 100U) << theta;
    EXPECT_FALSE(has_background(image)) << theta;
  }
  EXPECT_GE(section("inscribed-any").total(), section("inscribed").total());
}

TEST_F(ThetaOption, TakesACustomRectangleInTheUnit) {
  const cv::Mat image = section("custom:30,20,15,5,3,0", "voxel");
  EXPECT_EQ(image.size(), cv::Size(6, 4));
  EXPECT_FALSE(has_background(image));
}

TEST_F(ThetaOption, RefusesAnotherWordAndAnEdgeThatIsNotThere) {
  EXPECT_THAT(message_of<InvalidRequest>([&] { section("inscribed-all"); }),
              HasSubstr("--theta 'inscribed-all': did you mean inscribed-any?"));
  EXPECT_THAT(message_of<InvalidRequest>([&] { section("edge"); }),
              testing::AllOf(HasSubstr("--theta 'edge': give edge:I"), HasSubstr("edge:0")));
  EXPECT_THAT(message_of<InvalidRequest>([&] { section("custom"); }),
              HasSubstr("--theta 'custom': give custom:X,Y,Z,W,H,ANGLE"));
  EXPECT_THAT(message_of<InvalidRequest>([&] { section("edge:6"); }),
              HasSubstr("the section has no edge 6: it has "));
}

TEST_F(ThetaOption, AppliesToEachFrameOfASeries) {
  const std::filesystem::path frames = folder_.path() / "frames";
  const std::filesystem::path none = folder_.path() / "none";
  run({"series", sample_, "rotate", "--axis", "x", "--to", "90", "--step", "45", "--theta",
       "custom:0,0,0,400,100,0", "--pixel", "2", "--no-scale-bar", "-o", frames});
  EXPECT_EQ(reconstruct::names_in(frames).size(), 4U);  // with series.json
  // 400 um at 2 um a pixel, and one more since films want even sizes.
  for (const std::string& name : reconstruct::names_in(frames)) {
    if (!name.ends_with(".png")) {
      continue;
    }
    EXPECT_EQ(cv::imread(frames / name).cols, 202) << name;
  }
  EXPECT_THAT(message_of<InvalidRequest>([&] {
                run({"series", sample_, "rotate", "--axis", "x", "--step", "45", "--theta",
                     "edge:9", "-o", none});
              }),
              HasSubstr("no edge 9"));
  EXPECT_FALSE(std::filesystem::exists(none));
}

}  // namespace
}  // namespace biotomy::tools
