#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/temporary_folder.hpp"
#include "tools/command.hpp"

namespace biotomy::tools {
namespace {

class ExportCommand : public testing::Test {
 protected:
  ExportCommand() { reconstruct::VolumeWriter(sample_, {}).append(3, true); }

  void run(const std::vector<std::string>& options) const { run(options, folder_ / "out"); }

  void run(const std::vector<std::string>& options, const std::string& output) const {
    CLI::App app;
    add_export_command(app);
    std::vector<std::string> arguments{"export", sample_.path().string(), "-o", output};
    arguments.insert(arguments.end(), options.begin(), options.end());
    std::vector<std::string> last_first(arguments.rbegin(), arguments.rend());
    app.parse(last_first);
  }

  tests::TemporaryFolder folder_;
  reconstruct::SampleFolder sample_ =
      reconstruct::sample_with_layers(folder_ / "s", {20, 10, 3}, 8, 3);
};

TEST_F(ExportCommand, WritesOmeZarr) {
  run({"--ome-zarr", "0.4"});
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "0" / "0" / "0" / "0" / "0"));
}

TEST_F(ExportCommand, WritesTiffs) {
  run({"--tiff", "--region", "1:5,0:10,1:2"});
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / "000002.tif"));
}

TEST_F(ExportCommand, WritesNothingIntoASample) {
  const std::string inside = (sample_.path() / "stack").string();
  EXPECT_THROW(run({"--tiff"}, inside), reconstruct::InvalidRequest);
  EXPECT_FALSE(std::filesystem::exists(inside));
}

TEST_F(ExportCommand, RefusesAVolumeThatDoesNotFitTheDescriptionAsSectionDoes) {
  reconstruct::replace_text(sample_.path() / "sample.toml", "z = 50.0", "z = 25.0");
  for (const std::vector<std::string>& form :
       {std::vector<std::string>{"--tiff"}, std::vector<std::string>{"--ome-zarr", "0.4"}}) {
    EXPECT_THAT(reconstruct::message_of<reconstruct::SampleError>([&] { run(form); }),
                testing::AllOf(testing::HasSubstr("spacing_um.z is 50, in sample.toml 25"),
                               testing::HasSubstr("biotomy rebuild " + sample_.path().string())));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(ExportCommand, WantsOneForm) {
  EXPECT_THROW(run({}), reconstruct::InvalidRequest);
  EXPECT_THROW(run({"--tiff", "--ome-zarr", "0.4"}), reconstruct::InvalidRequest);
  EXPECT_THROW(run({"--ome-zarr", "0.3"}), CLI::ParseError);
  EXPECT_THROW(run({"--tiff", "--region", "1:2"}), reconstruct::InvalidRequest);
  EXPECT_THROW(run({"--tiff", "--level", "7"}), reconstruct::SampleError);
}

}  // namespace
}  // namespace biotomy::tools
