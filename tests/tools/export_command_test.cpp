#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "acquisition/records/sample_lock.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/store/volume_rebuild.hpp"
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

/// A sample of which a band of 4 layers is in the volume and 3 layers follow as images, as a job
/// leaves it.
class ExportOfAnUnfinishedSample : public ExportCommand {
 protected:
  ExportOfAnUnfinishedSample() {
    sample_ = reconstruct::sample_with_layers(folder_ / "u", {20, 10, 12}, 8, 7);
    reconstruct::VolumeLayout layout;
    layout.chunk = {4, 8, 8};
    layout.shard = {4, 16, 16};
    reconstruct::VolumeWriter(sample_, layout).append(7, false);
  }

  /// What is said on stderr.
  std::string warning_of(const std::vector<std::string>& options) const {
    testing::internal::CaptureStderr();
    run(options);
    return testing::internal::GetCapturedStderr();
  }
  std::size_t exported() const { return reconstruct::names_in(folder_ / "out").size(); }
  std::string rebuild() const { return "biotomy rebuild " + sample_.path().string(); }
};

TEST_F(ExportOfAnUnfinishedSample, NamesTheLayersThatItLacksAndTheRemedy) {
  EXPECT_EQ(warning_of({"--tiff"}), "biotomy: " + sample_.path().string() +
                                        ": layers 5 to 7 are not in the volume yet, nor in the "
                                        "export; " +
                                        rebuild() + " puts all layers there\n");
  EXPECT_EQ(exported(), 4U);
}

TEST_F(ExportOfAnUnfinishedSample, NamesThemWhateverTheForm) {
  std::filesystem::remove(sample_.layer_path(6));
  EXPECT_THAT(warning_of({"--ome-zarr", "0.4"}), testing::HasSubstr(": layer 5 is not in"));
}

TEST_F(ExportOfAnUnfinishedSample, SaysThatTheyFollowWhileADaemonWorksOnTheSample) {
  const acquisition::SampleLock daemon(sample_.path());
  EXPECT_THAT(warning_of({"--tiff"}),
              testing::AllOf(testing::HasSubstr("layers 5 to 7"),
                             testing::HasSubstr("what is missing follows when a band is full"),
                             testing::HasSubstr("stop biotomyd, and " + rebuild())));
}

TEST_F(ExportOfAnUnfinishedSample, SaysNothingWhereAllThatIsAskedForIsThere) {
  EXPECT_EQ(warning_of({"--tiff", "--region", "0:20,0:10,0:4"}), "");
  reconstruct::rebuild_volume(sample_);
  std::filesystem::remove_all(folder_ / "out");
  EXPECT_EQ(warning_of({"--tiff"}), "");
  EXPECT_EQ(exported(), 7U);
}

TEST_F(ExportOfAnUnfinishedSample, FailsWhereNoLayerIsInTheVolumeYet) {
  const auto failure = [&] {
    return reconstruct::message_of<reconstruct::SampleError>([&] { run({"--tiff"}); });
  };
  const std::string expected = sample_.path().string() +
                               ": has no layers in its volume to export: layers 1 to 7 are there "
                               "as images alone; " +
                               rebuild() + " puts all layers there";
  std::filesystem::remove_all(sample_.volume_path());
  EXPECT_EQ(failure(), expected);
  const reconstruct::VolumeWriter begun(sample_, {});
  EXPECT_EQ(failure(), expected);
  for (std::int64_t layer = 1; layer <= 7; ++layer) {
    std::filesystem::remove(sample_.layer_path(layer));
  }
  EXPECT_EQ(failure(), "the volume has no layers yet");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace biotomy::tools
