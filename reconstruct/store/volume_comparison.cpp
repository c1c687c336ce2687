#include "reconstruct/store/volume_comparison.hpp"

#include <algorithm>
#include <utility>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/layer_band.hpp"
#include "reconstruct/store/level_mean.hpp"
#include "reconstruct/store/metadata_text.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/shard_layers.hpp"
#include "reconstruct/store/stored_shard.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

constexpr int kMostComparisons = 4;  // of one shard: no volume grows that quickly

/// The first difference of two stacks of layers of one size.
std::optional<std::string> difference(const std::vector<cv::Mat>& found,
                                      const std::vector<cv::Mat>& expected) {
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::size_t row_bytes = static_cast<std::size_t>(found[k].cols) * found[k].elemSize();
    for (int y = 0; y < found[k].rows; ++y) {
      const unsigned char* a = found[k].ptr(y);
      const unsigned char* b = expected[k].ptr(y);
      const auto place = std::mismatch(a, a + row_bytes, b);
      if (place.first != a + row_bytes) {
        const auto x = static_cast<std::size_t>(place.first - a) / found[k].elemSize();
        return "at x " + std::to_string(x) + ", y " + std::to_string(y) + ", z " +
               std::to_string(k) + " of the shard";
      }
    }
  }
  return std::nullopt;
}

}  // namespace

fs::path shard_path(const fs::path& volume, const ShardPlace& place) {
  return volume / level_path(static_cast<int>(place.level)) / shard_key(place.z, place.y, place.x);
}

VolumeComparison::VolumeComparison(const SampleFolder& sample, const SampleGrowth& growth,
                                   VolumeMetadata group, const std::vector<ZarrArray>& arrays,
                                   IsBad is_bad)
    : sample_(sample),
      growth_(growth),
      volume_(sample.volume_path()),
      group_(std::move(group)),
      arrays_(arrays),
      is_bad_(std::move(is_bad)) {}

std::optional<std::string> VolumeComparison::fault_of(const ShardPlace& place) {
  std::optional<std::string> fault = fault_now(place);
  for (int i = 1; fault && i < kMostComparisons && has_grown(place); ++i) {
    fault = fault_now(place);
  }
  return fault;
}

/// Whether the volume has other layers now than when the shard was compared. Shards are replaced
/// before the metadata says so: where that may explain a difference, it is waited for.
bool VolumeComparison::has_grown(const ShardPlace& place) {
  bool waits = may_be_replaced(place);
  while (!read_layers_present()) {
    if (!waits) {
      return false;
    }
    waits = growth_.wait();
  }
  return true;
}

/// Of a shard that there is, only the level's last layer becomes another, and only while it is
/// the mean of fewer layers than it can be.
bool VolumeComparison::may_be_replaced(const ShardPlace& place) const {
  const std::int64_t depth = arrays_[place.level].layout.shard[0];
  const std::int64_t layers = layers_present_at(group_, place.level);
  return layers * group_.levels[place.level].z > group_.layers_present &&
         layers <= (place.z + 1) * depth;
}

/// False when they are as many as before.
bool VolumeComparison::read_layers_present() {
  const fs::path group_path = volume_ / kMetadataName;
  try {
    const std::int64_t layers =
        parse_group_metadata(read_metadata_file(group_path), group_path.string()).layers_present;
    return std::exchange(group_.layers_present, layers) != layers;
  } catch (const SampleError&) {
    return false;  // it was read before, and what is compared needs no more of it
  }
}

/// What is wrong with a shard of those layers that the volume has now.
std::optional<std::string> VolumeComparison::fault_now(const ShardPlace& place) const {
  const std::int64_t depth = arrays_[place.level].layout.shard[0];
  const std::int64_t first = place.z * depth;
  const std::int64_t end = std::min(first + depth, layers_present_at(group_, place.level));
  if (first >= end || is_bad_(place)) {
    return std::nullopt;  // the latter was told before
  }
  try {
    const auto stored = stored_layers(place.level, first, end, place.y, place.x);
    const auto expected =
        place.level == 0 ? layer_files(place, first, end) : means_of_finer(place, first, end);
    if (expected.empty()) {
      return std::nullopt;  // of what it is made is damaged, which was told before
    }
    if (const auto where = difference(stored, expected)) {
      return (place.level == 0
                  ? "is not what the layer files hold: "
                  : "is not the mean of level " + std::to_string(place.level - 1) + ": ") +
             *where;
    }
    return std::nullopt;
  } catch (const SampleError& error) {
    return std::string("cannot be compared: ") + error.what();
  }
}

std::vector<cv::Mat> VolumeComparison::layer_files(const ShardPlace& place, std::int64_t first,
                                                   std::int64_t end) const {
  return LayerBand(sample_, first + 1, end - first).read(region(0, place.y, place.x));
}

std::vector<cv::Mat> VolumeComparison::means_of_finer(const ShardPlace& place, std::int64_t first,
                                                      std::int64_t end) const {
  const std::size_t finer = place.level - 1;
  const HalvedAxes axes = halved_axes(group_.levels[finer], group_.levels[place.level]);
  const BlockCount shards = shards_of(arrays_[finer]);
  const std::int64_t depth = arrays_[finer].layout.shard[0];
  const std::int64_t finer_first = axes.z ? 2 * first : first;
  const std::int64_t finer_end = std::min(axes.z ? 2 * end : end, layers_present_at(group_, finer));
  const cv::Rect whole = region(place.level, place.y, place.x);
  std::vector<cv::Mat> means(static_cast<std::size_t>(end - first));
  for (cv::Mat& mean : means) {
    mean.create(whole.size(), group_.bits == 8 ? CV_8UC3 : CV_16UC3);
  }
  for (std::int64_t dy = 0; dy <= (axes.y ? 1 : 0); ++dy) {
    for (std::int64_t dx = 0; dx <= (axes.x ? 1 : 0); ++dx) {
      const std::int64_t y = (axes.y ? 2 * place.y : place.y) + dy;
      const std::int64_t x = (axes.x ? 2 * place.x : place.x) + dx;
      if (y >= shards.y || x >= shards.x) {
        continue;
      }
      for (std::int64_t z = finer_first / depth; z * depth < finer_end; ++z) {
        if (is_bad_(ShardPlace{finer, z, y, x})) {
          return {};
        }
      }
      const auto part = level_mean(stored_layers(finer, finer_first, finer_end, y, x), axes);
      const cv::Point corner = region(finer, y, x).tl();
      const cv::Rect inside(
          cv::Point(corner.x / (axes.x ? 2 : 1), corner.y / (axes.y ? 2 : 1)) - whole.tl(),
          part.front().size());
      for (std::size_t k = 0; k < means.size(); ++k) {
        part[k].copyTo(means[k](inside));
      }
    }
  }
  return means;
}

cv::Rect VolumeComparison::region(std::size_t level, std::int64_t y, std::int64_t x) const {
  const ZarrArray& array = arrays_[level];
  const auto& shard = array.layout.shard;
  return cv::Rect(static_cast<int>(x) * shard[2], static_cast<int>(y) * shard[1], shard[2],
                  shard[1]) &
         cv::Rect(0, 0, static_cast<int>(array.size.x), static_cast<int>(array.size.y));
}

/// Layers `first` to before `end` of a column of shards. Throws SampleError.
std::vector<cv::Mat> VolumeComparison::stored_layers(std::size_t level, std::int64_t first,
                                                     std::int64_t end, std::int64_t y,
                                                     std::int64_t x) const {
  const ZarrArray& array = arrays_[level];
  const std::int64_t depth = array.layout.shard[0];
  std::vector<cv::Mat> layers;
  for (std::int64_t layer = first; layer < end;) {
    const std::int64_t z = layer / depth;
    const std::int64_t count = std::min(end, (z + 1) * depth) - layer;
    const auto shard = StoredShard::open(shard_path(volume_, {level, z, y, x}), array);
    for (cv::Mat& each : shard_layers(shard, array, static_cast<int>(layer - z * depth),
                                      static_cast<int>(count), region(level, y, x).size())) {
      layers.push_back(std::move(each));
    }
    layer += count;
  }
  return layers;
}

}  // namespace biotomy::reconstruct
