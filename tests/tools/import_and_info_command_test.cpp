#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"
#include "tools/command.hpp"

namespace biotomy::tools {
namespace {

using reconstruct::InvalidRequest;
using reconstruct::SampleFolder;
using reconstruct::Volume;

/// Runs `biotomy` with import and info alone; gives what it printed.
class Commands : public testing::Test {
 protected:
  Commands() {
    std::filesystem::create_directory(images_);
    for (int i = 0; i < 3; ++i) {
      reconstruct::save_rgb(images_ + ("/face" + std::to_string(i) + ".png"),
                            reconstruct::test_image(20, 10));
    }
  }

  static std::string run(std::vector<std::string> arguments) {
    CLI::App app;
    add_import_command(app);
    add_info_command(app);
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    testing::internal::CaptureStdout();
    try {
      app.parse(arguments);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    return testing::internal::GetCapturedStdout();
  }

  tests::TemporaryFolder folder_;
  std::string images_ = (folder_.path() / "images").string();
  std::string sample_ = (folder_.path() / "sample").string();
};

TEST_F(Commands, ImportOfAFolderMakesASampleNamedAfterItsFolder) {
  EXPECT_EQ(run({"import", images_, "--spacing", "10,20,30", "-o", sample_}), "");
  const auto description = SampleFolder::open(sample_).description();
  EXPECT_EQ(description.name, "sample");
  EXPECT_EQ(description.cuboid.spacing, (reconstruct::Vector3{10, 20, 30}));
  EXPECT_EQ(description.cuboid.size, (reconstruct::GridSize{20, 10, 3}));
}

TEST_F(Commands, ImportTakesFilesAndTheSizeOfTheStack) {
  run({"import", images_ + "/face1.png", images_ + "/face0.png", "--size", "200,200,40", "-o",
       sample_, "--name", "knee"});
  const auto description = SampleFolder::open(sample_).description();
  EXPECT_EQ(description.name, "knee");
  EXPECT_EQ(description.cuboid.spacing, (reconstruct::Vector3{10, 20, 20}));
}

TEST_F(Commands, ImportBridgesGapsAndInfoTellsThem) {
  for (const int number : {4, 7, 9}) {
    reconstruct::save_rgb(images_ + "/face" + std::to_string(number) + ".png",
                          reconstruct::test_image(20, 10));
  }
  EXPECT_THROW(run({"import", images_, "--spacing", "10,20,30", "-o", sample_}),
               reconstruct::SampleError);
  run({"import", images_, "--spacing", "10,20,30", "-o", sample_, "--gaps", "repeat"});
  EXPECT_THAT(run({"info", sample_}),
              testing::HasSubstr("the layer before once more: 4, 6-7, 9\n"));
  EXPECT_EQ(nlohmann::json::parse(run({"info", sample_, "--json"})).at("repeated_layers"),
            (std::vector<int>{4, 6, 7, 9}));
}

TEST_F(Commands, ImportTakesNumbersThatGoInSteps) {
  run({"import", images_ + "/face0.png", images_ + "/face2.png", "--spacing", "10,20,30", "-o",
       sample_, "--number-step", "2"});
  EXPECT_EQ(SampleFolder::open(sample_).description().cuboid.size.z, 2);
  EXPECT_THAT(run({"info", sample_}), testing::Not(testing::HasSubstr("gaps")));
  for (const char* step : {"0", "-1", "a"}) {
    EXPECT_THROW(
        run({"import", images_, "--spacing", "1,1,1", "-o", sample_, "--number-step", step}),
        CLI::ParseError);
  }
}

TEST_F(Commands, ImportTakesNamesOfFilesInAnyEncoding) {
  const std::string images = images_ + "/l\xE4ge";  // Latin-1
  std::filesystem::create_directory(images);
  reconstruct::save_rgb(images + "/face.png", reconstruct::test_image(20, 10));
  std::filesystem::rename(images + "/face.png", images +
                                                    "/Gr\xFC\xDF"
                                                    "e 1.png");
  const std::string sample = sample_ + "\xFC";
  run({"import", images, "--spacing", "10,20,30", "-o", sample});
  EXPECT_EQ(SampleFolder::open(sample).description().name, "sample\xEF\xBF\xBD");
  EXPECT_EQ(nlohmann::json::parse(run({"info", sample, "--json"})).at("size").at(0), 20);
}

TEST_F(Commands, ImportRefusesANameThatIsNoText) {
  EXPECT_THROW(run({"import", images_, "--spacing", "1,1,1", "-o", sample_, "--name", "k\xE4se"}),
               InvalidRequest);
  EXPECT_THROW(run({"import", images_, "--spacing", "1,1,1", "-o", sample_, "--notes", "k\xE4se"}),
               InvalidRequest);
}

TEST_F(Commands, ImportTakesTheLayoutInTheOrderXYZ) {
  run({"import", images_, "--spacing", "1,1,1", "-o", sample_, "--chunk", "16,8,4", "--shard",
       "64,32,4", "--codec", "zstd1", "--colours", "planar"});
  const auto layout = Volume::open(SampleFolder::open(sample_).volume_path()).layout();
  EXPECT_EQ(layout.chunk, (std::array<int, 3>{4, 8, 16}));
  EXPECT_EQ(layout.shard, (std::array<int, 3>{4, 32, 64}));
  EXPECT_EQ(layout.codec, "zstd1");
  EXPECT_FALSE(layout.interleaved);
}

TEST_F(Commands, ImportWithoutAScaleIsWrongUsage) {
  EXPECT_THROW(run({"import", images_, "-o", sample_}), InvalidRequest);
  EXPECT_THROW(run({"import", images_, "-o", sample_, "--spacing", "1,1,1", "--size", "1,1,1"}),
               CLI::ParseError);
  EXPECT_THROW(run({"import", images_, "-o", sample_, "--spacing", "1,1"}), CLI::ParseError);
  EXPECT_THROW(run({"import", images_, "-o", sample_, "--spacing", "1,1,a"}), CLI::ParseError);
  for (const char* impossible : {"1,1,0", "1e-7,1,1", "1e10,1,1"}) {
    EXPECT_THROW(run({"import", images_, "-o", sample_, "--spacing", impossible}), InvalidRequest);
  }
}

TEST_F(Commands, ImportWithAnUnknownCodecIsWrongUsageBeforeAnyImageIsRead) {
  EXPECT_THROW(run({"import", "/nowhere", "--spacing", "1,1,1", "-o", sample_, "--codec", "zip"}),
               InvalidRequest);
}

TEST_F(Commands, InfoTellsPeopleAboutTheSample) {
  run({"import", images_, "--spacing", "10,20,30", "-o", sample_});
  const std::string text = run({"info", sample_});
  EXPECT_THAT(text, testing::HasSubstr("20 × 10 × 3"));
  EXPECT_THAT(text, testing::ContainsRegex("3 of 3, [1-9][0-9.]* (bytes|KiB)\n"));
  EXPECT_THAT(text, testing::ContainsRegex("volume +3 layers, [1-9][0-9.]* (bytes|KiB);"));
  EXPECT_THAT(text, testing::HasSubstr("blosc-lz4"));
  EXPECT_THAT(text, testing::HasSubstr("level 0  20 × 10 × 3 voxels of 10 × 20 × 30 µm"));
}

TEST_F(Commands, InfoTellsProgramsAboutTheSample) {
  run({"import", images_, "--spacing", "10,20,30", "-o", sample_});
  const auto info = nlohmann::json::parse(run({"info", sample_, "--json"}));
  EXPECT_EQ(info.at("size"), nlohmann::json({20, 10, 3}));
  EXPECT_EQ(info.at("spacing_um"), nlohmann::json({10.0, 20.0, 30.0}));
  EXPECT_EQ(info.at("layer_images").at("count"), 3);
  EXPECT_EQ(info.at("volume").at("layers"), 3);
  EXPECT_GT(info.at("volume").at("bytes"), 0);
  EXPECT_EQ(info.at("volume").at("levels").size(), 1U);
  EXPECT_EQ(info.at("volume").at("levels")[0].at("size"), nlohmann::json({20, 10, 3}));
}

TEST_F(Commands, InfoWarnsOfAVolumeThatDoesNotFitTheDescription) {
  run({"import", images_, "--spacing", "10,20,30", "-o", sample_});
  testing::internal::CaptureStderr();
  run({"info", sample_});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  reconstruct::replace_text(sample_ + "/sample.toml", "z = 30.0", "z = 15.0");
  for (const bool json : {false, true}) {
    testing::internal::CaptureStderr();
    const std::string text = json ? run({"info", sample_, "--json"}) : run({"info", sample_});
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "biotomy: " + sample_ +
                  "/volume.ome.zarr: does not fit the sample's description: spacing_um.z is 30, in "
                  "sample.toml 15; if sample.toml is right, biotomy rebuild " +
                  sample_ + " makes the volume anew\n");
    EXPECT_THAT(text, testing::HasSubstr(json ? "\"spacing_um\"" : "10 × 20 × 15 µm"));
  }
}

TEST_F(Commands, InfoOfASampleWithoutAVolumeSaysSo) {
  run({"import", images_, "--spacing", "10,20,30", "-o", sample_});
  std::filesystem::remove_all(SampleFolder::open(sample_).volume_path());
  EXPECT_THAT(run({"info", sample_}), testing::HasSubstr("none yet"));
  EXPECT_TRUE(nlohmann::json::parse(run({"info", sample_, "--json"})).at("volume").is_null());
}

TEST_F(Commands, InfoTellsHowFarSectionsReach) {
  run({"import", images_, "--spacing", "10,20,30", "-o", sample_});
  const SampleFolder sample = SampleFolder::open(sample_);
  const auto layers = [&] {
    return nlohmann::json::parse(run({"info", sample_, "--json"})).at("sections").at("layers");
  };
  EXPECT_EQ(layers(), 3);
  EXPECT_THAT(run({"info", sample_}), testing::HasSubstr("reach layer 3\n"));
  std::filesystem::remove_all(sample.volume_path());
  EXPECT_EQ(layers(), 3);
  std::filesystem::remove(sample.layer_path(2));
  EXPECT_EQ(layers(), 1);
}

TEST_F(Commands, InfoOfWhatIsNoSampleFails) {
  EXPECT_THROW(run({"info", folder_.path().string()}), reconstruct::SampleError);
}

}  // namespace
}  // namespace biotomy::tools
