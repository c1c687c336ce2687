#include "reconstruct/store/volume_verification.hpp"

#include <gmock/gmock.h>

#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/stored_shard.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/findings.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/reconstruct/whole_shard.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class VolumeVerification : public testing::Test {
 protected:
  VolumeVerification() {
    layout_.chunk = {2, 8, 16};
    layout_.shard = {6, 16, 32};
    layout_.codec = "zstd1";
    VolumeWriter(sample_, layout_).append(15, true);
  }
  std::vector<std::string> findings(bool deep = false) {
    HeardFindings heard(sample_.volume_path());
    shards_ = verify_volume(sample_, deep, heard.listener(), growth_);
    EXPECT_EQ(heard.done, heard.total);
    return heard.findings;
  }
  std::filesystem::path in_volume(const std::string& name) const {
    return sample_.volume_path() / name;
  }
  /// Stores the shard anew with one chunk of which one voxel is another.
  void change_a_voxel(const std::string& name) const {
    const BlockCount count = chunks_of_shard(layout_);
    const auto shard = StoredShard::open(in_volume(name), {{70, 45, 15}, 8, layout_});
    const ChunkCodec codec(layout_, 8);
    std::vector<std::vector<std::byte>> chunks;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count.total()); ++i) {
      chunks.push_back(shard->encoded(i));
    }
    std::vector<std::byte> voxels(codec.chunk_bytes());
    shard->decode(0, codec, voxels);
    voxels[3] ^= std::byte{1};
    chunks[0] = codec.encode(voxels);
    write_file(in_volume(name), whole_shard(chunks));
  }

  tests::TemporaryFolder folder_;
  VolumeLayout layout_;
  SampleFolder sample_ = sample_with_layers(folder_ / "s", {70, 45, 15}, 8, 15);
  SampleGrowth growth_;
  std::int64_t shards_ = 0;
};

TEST_F(VolumeVerification, FindsNothingInAVolumeThatIsWell) {
  EXPECT_THAT(findings(), IsEmpty());
  EXPECT_GT(shards_, 27);  // level 0 alone has as many
  EXPECT_THAT(findings(true), IsEmpty());
}

TEST_F(VolumeVerification, FindsNothingInAVolumeThatStillGrows) {
  const auto growing = sample_with_layers(folder_ / "g", {70, 45, 40}, 8, 15);
  VolumeWriter(growing, layout_).append(15, false);
  HeardFindings heard(growing.path());
  verify_volume(growing, true, heard.listener());
  EXPECT_THAT(heard.findings, IsEmpty());
}

TEST_F(VolumeVerification, FindsADamagedChunkOnceAndNamesIt) {
  flip_byte(in_volume("1/c/0/0/0/0"), 5);
  for (const bool deep : {false, true}) {
    EXPECT_THAT(findings(deep),
                ElementsAre(AllOf(StartsWith("1/c/0/0/0/0: its chunk z 0, y 0, x 0"),
                                  HasSubstr("checksum"))));
  }
}

TEST_F(VolumeVerification, FindsATruncatedShardAndADamagedIndex) {
  std::filesystem::resize_file(in_volume("0/c/0/1/0/0"), 9);
  const auto other = in_volume("0/c/0/2/0/0");
  flip_byte(other, std::filesystem::file_size(other) - 3);
  EXPECT_THAT(findings(), testing::UnorderedElementsAre(
                              AllOf(StartsWith("0/c/0/1/0/0: "), HasSubstr("truncated")),
                              AllOf(StartsWith("0/c/0/2/0/0: "), HasSubstr("index"))));
}

TEST_F(VolumeVerification, FindsAFileThatDoesNotBelongThere) {
  write_text(in_volume("0/c/0/0/0/99"), "x");
  write_text(in_volume("0/c/0/0/0/01"), "x");
  write_text(in_volume("0/notes"), "x");
  write_text(in_volume("0/c/0/0/0/.0.1-2"), "half");  // never finished: nothing wrong
  EXPECT_THAT(findings(),
              testing::UnorderedElementsAre("0/c/0/0/0/99: does not belong to the volume",
                                            "0/c/0/0/0/01: does not belong to the volume",
                                            "0/notes: does not belong to the volume"));
}

TEST_F(VolumeVerification, FindsMetadataThatIsDamagedOrContradictsTheSample) {
  write_text(in_volume("2/zarr.json"), "{}");
  EXPECT_THAT(findings(), ElementsAre(StartsWith("2/zarr.json: ")));
  std::filesystem::copy_file(in_volume("0/zarr.json"), in_volume("2/zarr.json"),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(findings(), ElementsAre(AllOf(StartsWith("2/zarr.json: "), HasSubstr("fit"))));
  VolumeMetadata metadata;
  metadata.name = "another";
  metadata.spacing = sample_.description().cuboid.spacing;
  metadata.layers_present = 15;
  write_text(in_volume("zarr.json"), group_metadata(metadata));
  EXPECT_THAT(findings(), ElementsAre(AllOf(StartsWith("zarr.json: "), HasSubstr("'another'"),
                                            HasSubstr("'test'"), HasSubstr("biotomy rebuild")),
                                      AllOf(StartsWith("zarr.json: "), HasSubstr("levels"))));
}

TEST_F(VolumeVerification, NamesWhatDiffersFromTheDescriptionAndTheRemedy) {
  const auto description = sample_.path() / "sample.toml";
  const auto findings_of_changed = [&] {
    HeardFindings heard(sample_.volume_path());
    verify_volume(SampleFolder::open(sample_.path()), false, heard.listener());
    return heard.findings;
  };
  const std::string remedy = "biotomy rebuild " + sample_.path().string();
  replace_text(description, "z = 50.0", "z = 45.0");
  EXPECT_THAT(
      findings_of_changed(),
      ElementsAre(AllOf(StartsWith("zarr.json: "),
                        HasSubstr("spacing_um.z is 50, in sample.toml 45"), HasSubstr(remedy))));
  replace_text(description, "z = 45.0", "z = 50.0");
  replace_text(description, "width = 70", "width = 71");
  EXPECT_THAT(
      findings_of_changed(),
      ElementsAre(AllOf(StartsWith("0/zarr.json: "),
                        HasSubstr("grid.width is 70, in sample.toml 71"), HasSubstr(remedy))));
}

TEST_F(VolumeVerification, FindsThatLayersAreNotInTheVolume) {
  const auto unfinished = sample_with_layers(folder_ / "u", {20, 10, 15}, 8, 15);
  VolumeWriter(unfinished, layout_).append(12, false);
  HeardFindings heard(unfinished.path());
  verify_volume(unfinished, false, heard.listener());
  EXPECT_THAT(heard.findings, ElementsAre(AllOf(StartsWith("volume.ome.zarr: "),
                                                HasSubstr("12 layers"), HasSubstr("1 to 15"))));
}

TEST_F(VolumeVerification, LetsABandBeOnItsWayIntoAVolumeThatGrows) {
  growth_.is_seen = [] { return true; };
  const auto counts = AllOf(StartsWith("volume.ome.zarr: "), HasSubstr("layers"));
  const auto findings_of = [&](std::int64_t layers, std::int64_t of, bool grows) {
    const auto sample = sample_with_layers(
        folder_ / (std::to_string(layers) + "of" + std::to_string(of)), {20, 10, of}, 8, layers);
    VolumeWriter(sample, layout_).append(5, false);
    HeardFindings heard(sample.path());
    verify_volume(sample, false, heard.listener(), grows ? growth_ : SampleGrowth());
    std::filesystem::remove_all(sample.path());
    return heard.findings;
  };
  EXPECT_THAT(findings_of(6, 40, true), IsEmpty());
  EXPECT_THAT(findings_of(11, 40, true), IsEmpty());
  EXPECT_THAT(findings_of(8, 8, true), IsEmpty());  // the job's last band
  EXPECT_THAT(findings_of(6, 40, false), ElementsAre(counts));
  EXPECT_THAT(findings_of(12, 40, true), ElementsAre(counts));
}

TEST_F(VolumeVerification, TellsAsFarAsWhichLayerTheFilesFollowEachOther) {
  std::filesystem::remove(sample_.layer_path(10));
  EXPECT_THAT(findings(),
              ElementsAre(".: holds 15 layers; layer files 1 to 9 follow without a gap"));
  std::filesystem::remove(sample_.layer_path(1));
  EXPECT_THAT(findings(), ElementsAre(".: holds 15 layers; there is no layer file 1"));
}

TEST_F(VolumeVerification, FindsThatThereIsNoVolume) {
  std::filesystem::remove_all(sample_.volume_path());
  EXPECT_THAT(findings(), ElementsAre(HasSubstr("rebuild")));
}

TEST_F(VolumeVerification, FindsOnlyWhenDeepAVoxelThatIsNotTheLayersOrNotTheMean) {
  change_a_voxel("0/c/0/1/0/0");
  EXPECT_THAT(findings(), IsEmpty());
  EXPECT_THAT(findings(true),
              testing::Contains(AllOf(StartsWith("0/c/0/1/0/0: "), HasSubstr("layer files"),
                                      HasSubstr("x 1, y 0, z 0"))));
  VolumeWriter(sample_, layout_, folder_ / "again").append(15, true);
  std::filesystem::remove_all(sample_.volume_path());
  std::filesystem::rename(folder_ / "again", sample_.volume_path());
  change_a_voxel("1/c/0/0/0/0");
  EXPECT_THAT(findings(true),
              testing::Contains(AllOf(StartsWith("1/c/0/0/0/0: "), HasSubstr("mean of level 0"))));
}

/// A volume to which a band is appended while it is verified: at level 2 and deeper, four layers
/// and more are one, and a band has two.
class VerificationOfAGrowingVolume : public testing::Test {
 protected:
  VerificationOfAGrowingVolume() { grow_to(2); }

  void grow_to(std::int64_t layers) {
    add_layers(sample_, writer_.layers_written() + 1, layers);
    writer_.append(layers, false);
  }

  /// `at_first` is called when the group has been read and no shard has been compared.
  std::vector<std::string> findings(const std::function<void()>& at_first) {
    HeardFindings heard(sample_.volume_path());
    VerificationListener listener = heard.listener();
    bool is_first = true;
    listener.progress = [&](std::int64_t, std::int64_t) {
      if (std::exchange(is_first, false)) at_first();
    };
    verify_volume(sample_, true, listener, growth_);
    return heard.findings;
  }
  std::string group() const {
    const auto text = read_file(sample_.volume_path() / "zarr.json");
    return {reinterpret_cast<const char*>(text.data()), text.size()};
  }
  void write_group(const std::string& text) const {
    write_text(sample_.volume_path() / "zarr.json", text);
  }

  tests::TemporaryFolder folder_;
  SampleFolder sample_ = sample_with_layers(folder_ / "s", {40, 40, 8}, 8, 0, {10, 10, 10});
  VolumeWriter writer_{sample_, {{2, 8, 8}, {2, 16, 16}, true, "zstd1"}};
  SampleGrowth growth_{.is_seen = [] { return true; }};
};

TEST_F(VerificationOfAGrowingVolume, ComparesAShardAgainThatANewBandHasChanged) {
  EXPECT_THAT(findings([&] { grow_to(4); }), IsEmpty());
  EXPECT_THAT(findings([&] { grow_to(8); }), IsEmpty());
}

TEST_F(VerificationOfAGrowingVolume, WaitsForTheMetadataOfABandWhoseShardsAreThere) {
  const std::string before = group();
  std::string after;
  growth_.wait = [&] {
    write_group(after);
    return true;
  };
  EXPECT_THAT(findings([&] {
                grow_to(4);
                after = group();
                write_group(before);
              }),
              IsEmpty());
  EXPECT_EQ(group(), after);
}

TEST_F(VerificationOfAGrowingVolume, TellsADifferenceThatNoNewBandExplains) {
  const std::string before = group();
  int waits = 0;
  growth_.wait = [&] { return ++waits < 3; };
  EXPECT_THAT(findings([&] {
                grow_to(4);
                write_group(before);
              }),
              testing::Contains(AllOf(StartsWith("2/c/0/0/0/0: "), HasSubstr("mean of level 1"))));
  EXPECT_GE(waits, 3);
}

TEST_F(VerificationOfAGrowingVolume, ComparesWhatCameWithTheNewBandToo) {
  EXPECT_THAT(findings([&] {
                grow_to(4);
                std::filesystem::copy_file(sample_.volume_path() / "2/c/0/0/0/0",
                                           sample_.volume_path() / "1/c/0/0/0/0",
                                           std::filesystem::copy_options::overwrite_existing);
              }),
              testing::Contains(StartsWith("1/c/0/0/0/0: is not the mean of level 0")));
}

TEST_F(VolumeVerification, FindsEveryShardThatIsLostOnce) {
  std::filesystem::remove(in_volume("0/c/0/0/0/1"));
  std::filesystem::remove(in_volume("2/c/0/0/0/0"));
  for (const bool deep : {false, true}) {
    EXPECT_THAT(findings(deep), ElementsAre(StartsWith("0/c/0/0/0/1: is missing"),
                                            StartsWith("2/c/0/0/0/0: is missing")));
  }
}

TEST_F(VolumeVerification, CountsShardsThatAreLostInsteadOfListingThemWithoutEnd) {
  layout_.chunk = {1, 4, 4};
  layout_.shard = {2, 4, 4};
  const auto sample = sample_with_layers(folder_ / "l", {60, 60, 2}, 8, 2);
  VolumeWriter(sample, layout_).append(2, true);
  std::filesystem::remove_all(sample.volume_path() / "0" / "c");  // 225 shards
  for (const bool deep : {false, true}) {
    HeardFindings heard(sample.volume_path());
    verify_volume(sample, deep, heard.listener());
    EXPECT_EQ(heard.done, heard.total);
    ASSERT_EQ(heard.findings.size(), 101U);
    EXPECT_THAT(heard.findings[99], StartsWith("0/c/0/0/6/9: is missing"));
    EXPECT_THAT(heard.findings[100], StartsWith(".: 125 more shards are missing"));
  }
}

TEST_F(VolumeVerification, RefusesMoreShardsThanAVolumeCanHave) {
  layout_.chunk = {1, 2, 2};
  layout_.shard = {1, 2, 2};
  const auto sample =
      sample_with_layers(folder_ / "h", {1'000'000, 1'000'000, 1'000'000}, 8, 0, {1, 1, 1});
  const VolumeWriter empty(sample, layout_);
  HeardFindings heard(sample.volume_path());
  verify_volume(sample, true, heard.listener());
  EXPECT_THAT(heard.findings, ElementsAre(AllOf(StartsWith("zarr.json: "), HasSubstr("shards"))));
}

TEST_F(VolumeVerification, FindsAShardThatIsLostOnlyWhenDeepWhereNotEveryOneIsStored) {
  const auto text = read_file(in_volume("zarr.json"));
  VolumeMetadata metadata =
      parse_group_metadata({reinterpret_cast<const char*>(text.data()), text.size()}, "zarr.json");
  metadata.every_shard = false;
  write_text(in_volume("zarr.json"), group_metadata(metadata));
  std::filesystem::remove(in_volume("0/c/0/0/0/1"));
  EXPECT_THAT(findings(), IsEmpty());
  EXPECT_THAT(findings(true), testing::Contains(StartsWith("0/c/0/0/0/1: ")));
}

}  // namespace
}  // namespace biotomy::reconstruct
