#include "reconstruct/store/pyramid_writer.hpp"

#include <map>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

#include "reconstruct/store/volume_writer.hpp"
#include "tests/reconstruct/test_files.hpp"
#include "tests/reconstruct/test_images.hpp"
#include "tests/reconstruct/volume_levels.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::reconstruct {
namespace {

struct Case {
  const char* name;
  GridSize size;
  Vector3 spacing;
  int bits;
  std::array<int, 3> chunk;
  std::array<int, 3> shard;
};

std::vector<cv::Mat> layers_of(const Case& stack) {
  std::vector<cv::Mat> layers;
  for (std::int64_t k = 0; k < stack.size.z; ++k) {
    layers.push_back(test_image(static_cast<int>(stack.size.x), static_cast<int>(stack.size.y),
                                stack.bits == 8 ? CV_8UC3 : CV_16UC3,
                                static_cast<std::uint64_t>(k + 1)));
  }
  return layers;
}

/// A sample without layer files: they are given to the writer from memory.
class EveryPyramid : public testing::TestWithParam<Case> {
 protected:
  SampleFolder new_sample(const std::string& name) const {
    SampleDescription description;
    description.name = "test";
    description.created = "2026-01-02T03:04:05Z";
    description.bits = GetParam().bits;
    description.cuboid = {GetParam().size, GetParam().spacing};
    return SampleFolder::create(folder_ / name, description);
  }
  VolumeWriter writer(const SampleFolder& sample) const {
    VolumeLayout layout;
    layout.chunk = GetParam().chunk;
    layout.shard = GetParam().shard;
    return {sample, layout};
  }
  std::int64_t layers_of_next_band(const VolumeWriter& volume) const {
    return std::min<std::int64_t>(volume.band_depth(), GetParam().size.z - volume.next_band());
  }
  /// Regions of the layers from `first` on, from 0.
  BandRegions regions(std::int64_t first, std::int64_t count) const {
    return [this, first, count](const cv::Rect& region) {
      std::vector<cv::Mat> parts;
      for (std::int64_t k = first; k < first + count; ++k) {
        parts.push_back(layers_[static_cast<std::size_t>(k)](region));
      }
      return parts;
    };
  }
  void append(VolumeWriter& volume, std::int64_t count) const {
    volume.append_band(count, regions(volume.next_band(), count));
  }
  void append_all(VolumeWriter& volume) const {
    while (volume.layers_written() < GetParam().size.z) {
      append(volume, layers_of_next_band(volume));
    }
  }
  void expect_right(const SampleFolder& sample, std::size_t layers_present) const {
    const Volume volume = Volume::open(sample.volume_path());
    std::vector<cv::Mat> expected(layers_.begin(),
                                  layers_.begin() + static_cast<std::ptrdiff_t>(layers_present));
    for (int level = 0; level < volume.levels(); ++level) {
      if (level > 0) {
        expected = slow_next_level(expected, volume.level(level - 1), volume.level(level));
      }
      const auto stored = stored_level(volume, level);
      ASSERT_GE(stored.size(), expected.size());
      for (std::size_t k = 0; k < stored.size(); ++k) {
        const cv::Mat black(stored[k].size(), stored[k].type(), cv::Scalar::all(0));
        ASSERT_TRUE(same_pixels(stored[k], k < expected.size() ? expected[k] : black))
            << "level " << level << ", layer " << k;
      }
    }
  }

  tests::TemporaryFolder folder_;
  std::vector<cv::Mat> layers_ = layers_of(GetParam());
};

TEST_P(EveryPyramid, HoldsTheMeansByTheirDefinition) {
  const SampleFolder sample = new_sample("s");
  VolumeWriter volume = writer(sample);
  append_all(volume);
  EXPECT_GT(Volume::open(sample.volume_path()).levels(), 2);
  expect_right(sample, layers_.size());
}

TEST_P(EveryPyramid, IsRightAfterEveryBandAlsoAnIncompleteOne) {
  const SampleFolder sample = new_sample("s");
  VolumeWriter volume = writer(sample);
  append(volume, layers_of_next_band(volume));
  expect_right(sample, static_cast<std::size_t>(volume.layers_written()));
  const std::int64_t part = std::max<std::int64_t>(1, layers_of_next_band(volume) / 2);
  append(volume, part);
  expect_right(sample, static_cast<std::size_t>(volume.layers_written()));
}

TEST_P(EveryPyramid, HasTheSameBytesHoweverItWasInterrupted) {
  const SampleFolder undisturbed = new_sample("undisturbed");
  VolumeWriter volume = writer(undisturbed);
  append_all(volume);

  const SampleFolder interrupted = new_sample("interrupted");
  std::int64_t written = 0;
  for (int call = 1; written < GetParam().size.z; ++call) {
    VolumeWriter again = writer(interrupted);
    const std::int64_t first = again.next_band();
    const std::int64_t count = layers_of_next_band(again);
    const BandRegions band = regions(first, count);
    int calls = 0;
    try {
      again.append_band(count, [&](const cv::Rect& region) {
        if (++calls == call) throw std::runtime_error("interrupted");
        return band(region);
      });
      call = 0;  // the band is done; the next is interrupted at its first region again
    } catch (const std::runtime_error&) {
    }
    written = writer(interrupted).layers_written();
  }
  EXPECT_THAT(differing_files(contents_of(interrupted.volume_path()),
                              contents_of(undisturbed.volume_path())),
              testing::IsEmpty());
}

TEST_P(EveryPyramid, HasTheSameBytesWhenABandIsWrittenAnewAfterItsLastShard) {
  const SampleFolder undisturbed = new_sample("undisturbed");
  VolumeWriter volume = writer(undisturbed);
  append_all(volume);

  const SampleFolder interrupted = new_sample("interrupted");
  const auto group = interrupted.volume_path() / "zarr.json";
  while (writer(interrupted).layers_written() < GetParam().size.z) {
    const auto before = read_file(group);
    VolumeWriter first = writer(interrupted);
    append(first, layers_of_next_band(first));
    write_file(group, before);  // as if the power had failed in front of it
    VolumeWriter second = writer(interrupted);
    append(second, layers_of_next_band(second));
  }
  EXPECT_THAT(differing_files(contents_of(interrupted.volume_path()),
                              contents_of(undisturbed.volume_path())),
              testing::IsEmpty());
}

TEST_P(EveryPyramid, HasTheSameBytesWhenEveryBandWasOnceIncomplete) {
  const SampleFolder undisturbed = new_sample("undisturbed");
  VolumeWriter volume = writer(undisturbed);
  append_all(volume);

  const SampleFolder halting = new_sample("halting");
  VolumeWriter halting_volume = writer(halting);
  while (halting_volume.layers_written() < GetParam().size.z) {
    append(halting_volume, std::max<std::int64_t>(1, layers_of_next_band(halting_volume) / 2));
    append(halting_volume, layers_of_next_band(halting_volume));
  }
  EXPECT_THAT(
      differing_files(contents_of(halting.volume_path()), contents_of(undisturbed.volume_path())),
      testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Stacks, EveryPyramid,
    testing::Values(Case{"cubic", {77, 53, 21}, {1, 1, 1}, 8, {8, 8, 8}, {8, 16, 16}},
                    Case{"flat_voxels", {50, 41, 30}, {10, 11, 50}, 8, {4, 4, 8}, {8, 16, 32}},
                    Case{"tall_voxels", {33, 35, 61}, {40, 40, 10}, 8, {4, 8, 8}, {4, 8, 16}},
                    Case{"deeper_than_a_band", {40, 30, 23}, {1, 1, 1}, 8, {1, 8, 8}, {2, 16, 16}},
                    Case{"bands_of_one_layer", {21, 19, 18}, {1, 1, 1}, 8, {1, 8, 8}, {1, 8, 8}},
                    Case{"bands_of_three_layers", {21, 19, 26}, {1, 2, 1}, 8, {3, 8, 8}, {3, 8, 8}},
                    Case{"sixteen_bits", {45, 39, 19}, {1, 1, 2}, 16, {4, 8, 8}, {4, 16, 16}}),
    [](const auto& each) { return std::string(each.param.name); });

TEST(LevelArrays, DifferInSizeAlone) {
  VolumeLayout layout;
  layout.codec = "zstd1";
  const auto arrays = level_arrays({{101, 50, 7}, 16, layout}, {{1, 1, 1}, {2, 2, 1}, {4, 4, 2}});
  ASSERT_EQ(arrays.size(), 3U);
  EXPECT_EQ(arrays[0], (ZarrArray{{101, 50, 7}, 16, layout}));
  EXPECT_EQ(arrays[1], (ZarrArray{{51, 25, 7}, 16, layout}));
  EXPECT_EQ(arrays[2], (ZarrArray{{26, 13, 4}, 16, layout}));
}

}  // namespace
}  // namespace biotomy::reconstruct
