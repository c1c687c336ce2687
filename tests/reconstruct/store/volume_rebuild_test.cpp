#include "reconstruct/store/volume_rebuild.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/volume.hpp"
#include "reconstruct/store/volume_verification.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/another_user.hpp"
#include "tests/reconstruct/findings.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/reconstruct/volume_levels.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

class VolumeRebuild : public testing::Test {
 protected:
  VolumeRebuild() {
    layout_.chunk = {2, 8, 16};
    layout_.shard = {4, 16, 32};
    layout_.codec = "zstd1";
  }
  auto volume_contents() const { return contents_of(sample_.volume_path()); }
  auto names() const { return names_in(sample_.path()); }

  tests::TemporaryFolder folder_;
  VolumeLayout layout_;
  SampleFolder sample_ = sample_with_layers(folder_ / "s", {70, 45, 15}, 8, 13);
};

TEST_F(VolumeRebuild, GivesByteForByteWhatWasAppendedBandByBand) {
  VolumeWriter writer(sample_, layout_);
  for (const int available : {5, 8, 12, 13}) {
    writer.append(available, available == 13);
  }
  const auto appended = volume_contents();
  std::vector<std::int64_t> progress;
  EXPECT_EQ(rebuild_volume(sample_,
                           [&](std::int64_t done, std::int64_t total) {
                             progress.push_back(done);
                             EXPECT_EQ(total, 13);
                           }),
            13);
  EXPECT_THAT(differing_files(volume_contents(), appended), testing::IsEmpty());
  EXPECT_THAT(progress, testing::ElementsAre(4, 8, 12, 13));
  EXPECT_THAT(names(),
              UnorderedElementsAre("sample.toml", "layers", "rejected", "volume.ome.zarr"));
}

TEST_F(VolumeRebuild, MendsAVolumeThatIsDamagedAndKeepsItsLayout) {
  VolumeWriter(sample_, layout_).append(13, true);
  const auto appended = volume_contents();
  write_text(sample_.volume_path() / "zarr.json", "{}");
  std::filesystem::remove_all(sample_.volume_path() / "1");
  rebuild_volume(sample_);
  EXPECT_THAT(differing_files(volume_contents(), appended), testing::IsEmpty());
}

TEST_F(VolumeRebuild, GivesAStoreOfOneLevelItsLevels) {
  VolumeWriter(sample_, layout_).append(13, true);
  const auto appended = volume_contents();
  VolumeMetadata metadata;
  metadata.name = "test";
  metadata.spacing = sample_.description().cuboid.spacing;
  metadata.layers_present = 13;
  write_text(sample_.volume_path() / "zarr.json", group_metadata(metadata));
  ASSERT_EQ(Volume::open(sample_.volume_path()).levels(), 1);
  rebuild_volume(sample_);
  EXPECT_THAT(differing_files(volume_contents(), appended), testing::IsEmpty());
}

TEST_F(VolumeRebuild, TakesOverWhatWasCorrectedInTheDescription) {
  VolumeWriter(sample_, layout_).append(13, true);
  replace_text(sample_.path() / "sample.toml", "z = 50.0", "z = 20.0");
  const SampleFolder corrected = SampleFolder::open(sample_.path());
  ASSERT_THROW(Volume::of_sample(corrected), SampleError);
  rebuild_volume(corrected);
  const Volume volume = Volume::of_sample(corrected);
  EXPECT_EQ(volume.cuboid().spacing, (Vector3{10.0, 11.0, 20.0}));
  EXPECT_EQ(volume.layers_present(), 13);
  EXPECT_EQ(volume.layout(), layout_);
  // The levels follow from the spacing: they are those of a volume that was begun with it.
  VolumeWriter(corrected, layout_, folder_ / "begun").append(13, true);
  EXPECT_THAT(differing_files(volume_contents(), contents_of(folder_ / "begun")),
              testing::IsEmpty());
  HeardFindings heard(sample_.path());
  verify_volume(corrected, true, heard.listener());
  EXPECT_THAT(heard.findings, testing::IsEmpty());
}

TEST_F(VolumeRebuild, MakesAVolumeWhereThereIsNone) {
  rebuild_volume(sample_);
  const Volume volume = Volume::open(sample_.volume_path());
  EXPECT_EQ(volume.layers_present(), 13);
  EXPECT_EQ(volume.layout(), VolumeLayout{});
}

TEST_F(VolumeRebuild, RefusesWhenALayerIsMissingInTheMiddleOrAllAre) {
  std::filesystem::remove(sample_.layer_path(6));
  EXPECT_THAT(message_of<SampleError>([&] { rebuild_volume(sample_); }), HasSubstr("000006.tif"));
  for (std::int64_t layer = 1; layer <= 13; ++layer) {
    std::filesystem::remove(sample_.layer_path(layer));
  }
  EXPECT_THAT(message_of<SampleError>([&] { rebuild_volume(sample_); }), HasSubstr("no layers"));
  EXPECT_THAT(names(), UnorderedElementsAre("sample.toml", "layers", "rejected"));
}

TEST_F(VolumeRebuild, LosesNoLayersOfWhichOnlyTheVolumeIsLeft) {
  VolumeWriter(sample_, layout_).append(13, true);
  const auto appended = volume_contents();
  std::filesystem::remove(sample_.layer_path(12));
  std::filesystem::remove(sample_.layer_path(13));
  EXPECT_THAT(message_of<SampleError>([&] { rebuild_volume(sample_); }),
              AllOf(HasSubstr("000012.tif"), HasSubstr("would lose 2")));
  EXPECT_THAT(differing_files(volume_contents(), appended), testing::IsEmpty());
  std::filesystem::rename(sample_.volume_path(), folder_ / "aside");
  EXPECT_EQ(rebuild_volume(sample_), 11);
}

TEST_F(VolumeRebuild, LosesNoLayersOfAVolumeWhoseMetadataIsDamaged) {
  VolumeWriter(sample_, layout_).append(13, true);
  const auto metadata = [&](const std::string& level) {
    return sample_.volume_path() / level / "zarr.json";
  };
  write_text(metadata(""), "{}");
  std::filesystem::remove(sample_.layer_path(13));  // of the deepest band, which has no other
  const auto rebuild = [&] { rebuild_volume(sample_); };
  const auto refused = [](const std::string& held) {
    return AllOf(HasSubstr("000013.tif"), HasSubstr("zarr.json is missing or damaged"),
                 HasSubstr(held + " layers"), HasSubstr("put the files back, or move"));
  };
  EXPECT_THAT(message_of<SampleError>(rebuild), refused("13"));
  write_text(metadata("0"), "{}");  // the next level says how deep a shard is, too
  EXPECT_THAT(message_of<SampleError>(rebuild), refused("13"));
  for (int level = 1; std::filesystem::remove(metadata(level_path(level))); ++level) {
  }
  EXPECT_THAT(message_of<SampleError>(rebuild), refused("15"));  // as many as there can be
  std::filesystem::rename(sample_.volume_path(), folder_ / "aside");
  EXPECT_EQ(rebuild_volume(sample_), 12);
}

TEST_F(VolumeRebuild, LosesNoLayersOfABandOfWhichSomeFilesAreThere) {
  std::filesystem::remove(sample_.layer_path(13));
  VolumeWriter(sample_, layout_).append(12, true);
  write_text(sample_.volume_path() / "zarr.json", "{}");
  std::filesystem::remove(sample_.layer_path(12));
  EXPECT_THAT(message_of<SampleError>([&] { rebuild_volume(sample_); }),
              AllOf(HasSubstr("000012.tif"), HasSubstr("would lose 1")));
}

TEST_F(VolumeRebuild, PutsTheVolumeBackThatOneLeftAsideWhichWasKilled) {
  VolumeWriter(sample_, layout_).append(13, true);
  const auto appended = volume_contents();
  std::filesystem::rename(sample_.volume_path(), sample_.path() / ".volume.ome.zarr.partial.old");
  EXPECT_THAT(left_by_rebuilds(sample_),
              testing::ElementsAre(sample_.path() / ".volume.ome.zarr.partial.old"));
  std::filesystem::remove(sample_.layer_path(13));
  EXPECT_THAT(message_of<SampleError>([&] { rebuild_volume(sample_); }), HasSubstr("would lose 1"));
  EXPECT_THAT(differing_files(volume_contents(), appended), testing::IsEmpty());
  EXPECT_THAT(left_by_rebuilds(sample_), testing::IsEmpty());
}

TEST_F(VolumeRebuild, GivesWhatRootMakesToTheOwnerOfTheSample) {
  if (!tests::AnotherUser::can_be()) GTEST_SKIP() << "only root can be another user";
  ASSERT_EQ(::chown(sample_.path().c_str(), tests::AnotherUser::kNumber, 54321), 0);
  rebuild_volume(sample_);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(sample_.volume_path())) {
    struct stat found {};
    ASSERT_EQ(::stat(entry.path().c_str(), &found), 0);
    EXPECT_EQ(found.st_uid, tests::AnotherUser::kNumber) << entry.path();
    EXPECT_EQ(found.st_gid, 54321U) << entry.path();
  }
}

TEST_F(VolumeRebuild, LeavesTheOldVolumeWhenALayerIsDamaged) {
  VolumeWriter(sample_, layout_).append(13, true);
  const auto appended = volume_contents();
  truncate_file(sample_.layer_path(11), 0.5);
  EXPECT_THAT(message_of<SampleError>([&] { rebuild_volume(sample_); }), HasSubstr("000011.tif"));
  EXPECT_THAT(differing_files(volume_contents(), appended), testing::IsEmpty());
  EXPECT_THAT(names(),
              UnorderedElementsAre("sample.toml", "layers", "rejected", "volume.ome.zarr"));
}

TEST_F(VolumeRebuild, StopsWhenAskedAndLeavesTheOldVolume) {
  VolumeWriter(sample_, layout_).append(13, true);
  const auto appended = volume_contents();
  int questions = 0;
  EXPECT_THROW(rebuild_volume(sample_, {}, [&] { return ++questions == 20; }), Interrupted);
  EXPECT_THAT(differing_files(volume_contents(), appended), testing::IsEmpty());
  EXPECT_THAT(names(),
              UnorderedElementsAre("sample.toml", "layers", "rejected", "volume.ome.zarr"));
}

TEST_F(VolumeRebuild, BeginsAnewAfterOneThatWasKilled) {
  const auto left = sample_.path() / ".volume.ome.zarr.partial";
  VolumeWriter(sample_, layout_, left).append(8, false);
  write_text(left / "zarr.json", "half");
  rebuild_volume(sample_);
  EXPECT_EQ(Volume::open(sample_.volume_path()).layers_present(), 13);
  EXPECT_FALSE(std::filesystem::exists(left));
}

TEST_F(VolumeRebuild, IsReadOnByThoseWhoHadTheOldVolumeOpen) {
  VolumeWriter(sample_, layout_).append(13, true);
  const Volume volume = Volume::open(sample_.volume_path());
  const auto before = stored_level(volume, 1);
  rebuild_volume(sample_);
  const auto after = stored_level(volume, 1);
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_TRUE(same_pixels(before[k], after[k])) << k;
  }
}

}  // namespace
}  // namespace biotomy::reconstruct
