#include "reconstruct/bricks/volume_bricks.hpp"

#include <array>
#include <cstring>
#include <memory>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/watched_reader.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using tests::TemporaryFolder;

constexpr int kLayers = 12;
constexpr int kStoredLayers = 8;  // the rest was never written
const cv::Size kLayerSize{64, 40};
constexpr PlaneReach kAllOfIt{};                 // a plane that everything is near
constexpr std::size_t kIndexBytes = 8 * 16 + 4;  // of a shard of 8 chunks

cv::Mat layer_image(int layer, int bits) {
  cv::Mat image(kLayerSize, bits == 8 ? CV_8UC3 : CV_16UC3);
  cv::RNG random(static_cast<std::uint64_t>(layer));
  random.fill(image, cv::RNG::UNIFORM, 0, bits == 8 ? 256 : 65536);
  return image;
}

/// A sample of noise.
struct Written {
  TemporaryFolder folder;
  SampleFolder sample;

  explicit Written(int bits) : sample(SampleFolder::create(folder / "noise", description(bits))) {
    for (int layer = 1; layer <= kLayers; ++layer) {
      write_layer_image(sample.layer_path(layer), layer_image(layer, bits),
                        {layer, description(bits).cuboid.spacing}, {});
    }
    VolumeLayout layout;
    layout.chunk = {8, 16, 16};
    layout.shard = {8, 32, 64};
    VolumeWriter(sample, layout).append(kStoredLayers, false);
  }

  static SampleDescription description(int bits) {
    SampleDescription result;
    result.name = "noise";
    result.bits = bits;
    result.cuboid = {{kLayerSize.width, kLayerSize.height, kLayers}, {10.0, 10.0, 25.0}};
    result.created = "2026-01-01T00:00:00Z";
    return result;
  }
};

/// Written once for each number of bits, copied for each test.
class VolumeAsBricks : public testing::TestWithParam<int> {
 protected:
  static void SetUpTestSuite() {
    written_[0] = std::make_unique<Written>(8);
    written_[1] = std::make_unique<Written>(16);
  }
  static void TearDownTestSuite() { written_ = {}; }

  VolumeAsBricks() {
    std::filesystem::copy(written_[bits() == 8 ? 0 : 1]->sample.volume_path(), path_,
                          std::filesystem::copy_options::recursive);
  }

  static int bits() { return GetParam(); }
  Volume open() const { return Volume::open(path_); }

  /// Changes a byte of the chunk at this place among those of the first shard, which lie side by
  /// side.
  void damage(std::size_t place) const {
    const Volume volume = open();
    volume.read_chunks(0, std::span(run_).first(place), [](std::size_t, auto) {});
    const auto before = static_cast<std::size_t>(volume.statistics().bytes_read);
    flip_byte(shard_, (place == 0 ? 0 : before - kIndexBytes) + 40);
  }

  /// The first texel, as it would be painted.
  std::array<int, 3> first_texel(const TexelBrick& brick) const {
    std::array<int, 3> levels{};
    for (std::size_t colour = 0; colour < 3; ++colour) {
      if (bits() == 8) {
        levels[colour] = std::to_integer<int>(brick.get()[colour]);
      } else {
        std::uint16_t level = 0;
        std::memcpy(&level, brick.get() + 2 * colour, sizeof level);
        levels[colour] = level;
      }
    }
    return levels;
  }

  static inline std::array<std::unique_ptr<Written>, 2> written_;

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "volume";
  std::filesystem::path shard_ = path_ / "0" / "c" / "0" / "0" / "0" / "0";
  const std::vector<ChunkIndex> run_{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 1, 0}};
};

INSTANTIATE_TEST_SUITE_P(EightAndSixteenBits, VolumeAsBricks, testing::Values(8, 16),
                         testing::PrintToStringParamName());

TEST_P(VolumeAsBricks, GivesTheLayersOfAStoredSampleBackAsSections) {
  const Volume volume = open();
  VolumeBricks source(volume, 1'000'000);
  EXPECT_EQ(source.brick_shape(), volume.layout().chunk);
  EXPECT_EQ(source.bits(), bits());
  EXPECT_EQ(source.levels(), volume.levels());
  for (int layer = 1; layer <= kLayers; ++layer) {
    const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, (layer - 1) * 25.0});
    const Section section =
        cut_section(source, {plane, section_basis(BasisKind::layer, plane), {}});
    EXPECT_EQ(section.image.size(), kLayerSize);
    const cv::Mat wanted = layer <= kStoredLayers
                               ? layer_image(layer, bits())
                               : cv::Mat(kLayerSize, section.image.type(), cv::Scalar::all(0));
    EXPECT_EQ(cv::norm(section.image, wanted, cv::NORM_INF), 0.0) << layer;
    EXPECT_EQ(section.statistics.chunks_touched, 12);
  }
  // Each chunk twice, as what a second section needs was left out for the first; then no more.
  EXPECT_EQ(volume.statistics().chunks_read, 24);
}

TEST_P(VolumeAsBricks, AreReadASecondTimeForAnotherPlaneAndThenNoMore) {
  const Volume volume = open();
  VolumeBricks source(volume, 10'000'000);
  const std::vector<ChunkIndex> later{{0, 2, 0}, {0, 2, 1}};
  const auto chunks_read_for = [&](double layer, const std::vector<ChunkIndex>& wanted) {
    const std::int64_t before = volume.statistics().chunks_read;
    source.bricks(0, wanted, {{0.0, 0.0, 1.0}, layer, 0.5});
    return volume.statistics().chunks_read - before;
  };
  EXPECT_EQ(chunks_read_for(2.0, run_), 5);
  EXPECT_EQ(chunks_read_for(3.0, run_), 0) << "in the same cells";
  EXPECT_EQ(chunks_read_for(5.0, run_), 5);
  EXPECT_EQ(chunks_read_for(2.0, run_), 0);
  EXPECT_EQ(chunks_read_for(7.0, run_), 0) << "the second time all cells were read";
  EXPECT_EQ(chunks_read_for(2.0, later), 2);
  EXPECT_EQ(chunks_read_for(7.0, later), 0) << "there are several planes: all was read at once";
}

TEST_P(VolumeAsBricks, AreReadOnceWhereAllOfAChunkIsDecodedAnyway) {
  VolumeLayout layout;
  layout.chunk = {8, 16, 16};
  layout.shard = {8, 32, 64};
  layout.codec = "zstd1";
  const SampleFolder& sample = written_[bits() == 8 ? 0 : 1]->sample;
  VolumeWriter(sample, layout, folder_ / "other").append(kStoredLayers, false);
  const Volume volume = Volume::open(folder_ / "other");
  VolumeBricks source(volume, 10'000'000);
  source.bricks(0, run_, {{0.0, 0.0, 1.0}, 2.0, 0.5});
  source.bricks(0, run_, {{0.0, 0.0, 1.0}, 5.0, 0.5});
  EXPECT_EQ(volume.statistics().chunks_read, 5);
}

TEST_P(VolumeAsBricks, KeepsWhatFitsAndReadsTheRestAgain) {
  const Volume volume = open();
  const std::size_t brick_bytes = TexelBlocks(volume.layout().chunk, bits()).brick_bytes();
  VolumeBricks source(volume, 2 * brick_bytes);
  EXPECT_EQ(source.capacity_bytes(), 2 * brick_bytes);
  const auto chunks_read_by = [&](const std::vector<ChunkIndex>& wanted) {
    const std::int64_t before = volume.statistics().chunks_read;
    source.bricks(0, wanted, kAllOfIt);
    return volume.statistics().chunks_read - before;
  };
  EXPECT_EQ(chunks_read_by({run_[0], run_[1]}), 2);
  EXPECT_EQ(chunks_read_by({run_[0], run_[1]}), 0);
  EXPECT_EQ(chunks_read_by({run_[2]}), 1);
  EXPECT_EQ(chunks_read_by({run_[1]}), 0);
  EXPECT_EQ(chunks_read_by({run_[0]}), 1);
}

TEST_P(VolumeAsBricks, OfFillValueAreNull) {
  const Volume volume = open();
  VolumeBricks source(volume, 1'000'000);
  const std::vector<ChunkIndex> wanted{{1, 0, 0}, {0, 0, 0}};
  const std::vector<TexelBrick> bricks = source.bricks(0, wanted, kAllOfIt);
  EXPECT_EQ(bricks[0], nullptr);
  EXPECT_NE(bricks[1], nullptr);
}

TEST_P(VolumeAsBricks, ExpectsOnlyWhatItDoesNotHave) {
  const auto record = std::make_shared<WatchedReader::Record>();
  const Volume volume = Volume::open(std::make_unique<WatchedReader>(path_, record, 64));
  VolumeBricks source(volume, 10'000'000);
  source.bricks(0, run_, kAllOfIt);
  source.expect(0, run_, kAllOfIt);
  EXPECT_TRUE(record->expected.empty());
  const std::vector<ChunkIndex> two{run_[0], {0, 2, 0}};
  source.expect(0, two, kAllOfIt);
  EXPECT_EQ(record->expected.size(), 1U);
}

TEST_P(VolumeAsBricks, ThrowsWhatIsDamagedAndNamesTheShard) {
  damage(2);
  const Volume volume = open();
  VolumeBricks source(volume, 10'000'000);
  EXPECT_THAT(message_of<SampleError>([&] { source.bricks(0, run_, kAllOfIt); }),
              AllOf(StartsWith(shard_.string()), HasSubstr("chunk z 0, y 0, x 2 is damaged")));
  EXPECT_EQ(source.damage().chunks, 0);
  EXPECT_NE(source.bricks(0, std::vector<ChunkIndex>{run_[0]}, kAllOfIt)[0], nullptr);
}

TEST_P(VolumeAsBricks, ToleratesADamagedChunkInTheMiddleOfOthers) {
  std::vector<TexelBrick> whole;
  {
    const Volume volume = open();
    whole = VolumeBricks(volume, 10'000'000).bricks(0, run_, kAllOfIt);
  }
  damage(2);
  const Volume volume = open();
  VolumeBricks source(volume, 10'000'000, {true, {10, 20, 30}});
  const std::vector<TexelBrick> bricks = source.bricks(0, run_, kAllOfIt);
  for (const std::size_t i : {0U, 1U, 3U, 4U}) {
    EXPECT_EQ(first_texel(bricks[i]), first_texel(whole[i]));
  }
  const int scale = bits() == 8 ? 1 : 257;
  EXPECT_EQ(first_texel(bricks[2]), (std::array{10 * scale, 20 * scale, 30 * scale}));
  EXPECT_EQ(source.damage().chunks, 1);
  EXPECT_THAT(source.damage().first,
              AllOf(StartsWith(shard_.string()), HasSubstr("chunk z 0, y 0, x 2 is damaged")));
}

TEST_P(VolumeAsBricks, PaintsAllOfADamagedChunk) {
  damage(0);
  const Volume volume = open();
  VolumeBricks source(volume, 10'000'000, {true, {10, 20, 30}});
  const int scale = bits() == 8 ? 1 : 257;
  const Plane plane = Plane::from_normal({0, 0, 1}, {0, 0, 0});
  const cv::Mat image =
      cut_section(source, {plane, section_basis(BasisKind::layer, plane), {}}).image;
  cv::Mat wanted = layer_image(1, bits());
  wanted(cv::Rect(0, 0, 16, 16)) = cv::Scalar(10 * scale, 20 * scale, 30 * scale);
  EXPECT_EQ(cv::norm(image, wanted, cv::NORM_INF), 0.0);
}

TEST_P(VolumeAsBricks, CountsEachDamagedChunkOnceAndTellsOneOfThem) {
  truncate_file(shard_, 0.0);
  const Volume volume = open();
  VolumeBricks source(volume, 10'000'000, {true, {}});
  source.bricks(0, run_, kAllOfIt);
  source.bricks(0, run_, kAllOfIt);  // they are kept, like any others
  EXPECT_EQ(source.damage().chunks, static_cast<std::int64_t>(run_.size()));
  EXPECT_THAT(source.damage().first, HasSubstr("shorter than its index"));
}

TEST_P(VolumeAsBricks, DoesNotTakePaintOverForWhatTheVolumeHolds) {
  damage(2);
  const Volume volume = open();
  VolumeBricks tolerant(volume, 10'000'000, {true, {10, 20, 30}});
  tolerant.bricks(0, run_, kAllOfIt);
  ASSERT_EQ(tolerant.damage().chunks, 1);
  VolumeBricks strict(volume, 10'000'000, {}, nullptr, tolerant);
  EXPECT_THAT(message_of<SampleError>([&] { strict.bricks(0, run_, kAllOfIt); }),
              HasSubstr("chunk z 0, y 0, x 2 is damaged"));
}

}  // namespace
}  // namespace biotomy::reconstruct
