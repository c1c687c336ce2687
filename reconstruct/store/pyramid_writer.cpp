#include "reconstruct/store/pyramid_writer.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/disk/write_behind.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/level_mean.hpp"
#include "reconstruct/store/missing_part.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/shard_layers.hpp"
#include "reconstruct/store/stored_shard.hpp"
#include "reconstruct/whole_loop.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<std::byte>;

constexpr std::size_t kBytesBehind = std::size_t{128} << 20;
constexpr int kThreadsBehind = 2;

/// Layers of a level, from `first` to before `end`.
struct LayerRange {
  std::int64_t first = 0;
  std::int64_t end = 0;

  std::int64_t count() const { return end - first; }
};

/// Of a level, that a range of level 0's layers has a part in.
LayerRange layers_of_level(const LayerRange& finest, const LevelFactor& factor) {
  return {finest.first / factor.z, (finest.end + factor.z - 1) / factor.z};
}

bool all_fill(std::span<const std::byte> bytes) {
  return bytes.empty() || (bytes[0] == std::byte{0} &&
                           std::memcmp(bytes.data(), bytes.data() + 1, bytes.size() - 1) == 0);
}

/// One shard on its way to the disk: layers `range` of its level come from memory, those before
/// from the shard as it was, and what is deeper is fill value.
class ShardEncoder {
 public:
  ShardEncoder(const ZarrArray& array, const LayerRange& range, const std::vector<cv::Mat>& layers,
               const std::optional<StoredShard>& before)
      : layout_(array.layout),
        codec_(array.layout, array.bits),
        count_(chunks_of_shard(array.layout)),
        first_(static_cast<int>(range.first % array.layout.shard[0])),
        layers_(layers),
        before_(before) {}

  /// Its chunks and its index, as they stand in the file.
  FileParts encode() const {
    FileParts parts(static_cast<std::size_t>(count_.total()));
    whole_loop(parts.size(), [&](std::size_t place) { parts[place] = encode_chunk(place); });
    parts.push_back(encode_shard_index(parts));
    return parts;
  }

 private:
  int end() const { return first_ + static_cast<int>(layers_.size()); }

  Bytes encode_chunk(std::size_t number) const {
    const auto place = static_cast<std::int64_t>(number);
    const int z = static_cast<int>(place / (count_.x * count_.y)) * layout_.chunk[0];
    const cv::Rect face(cv::Point(static_cast<int>(place % count_.x) * layout_.chunk[2],
                                  static_cast<int>(place / count_.x % count_.y) * layout_.chunk[1]),
                        cv::Size(layout_.chunk[2], layout_.chunk[1]));
    const cv::Rect inside = face & cv::Rect(cv::Point(0, 0), layers_.front().size());
    if (inside.empty() || z >= end()) {
      return {};
    }
    if (z + layout_.chunk[0] <= first_) {
      return before_ ? before_->encoded(number) : Bytes{};
    }
    Bytes voxels(codec_.chunk_bytes());
    if (z < first_ && before_) {
      before_->decode(number, codec_, voxels);
    }
    for (int dz = 0; dz < layout_.chunk[0]; ++dz) {
      if (z + dz >= first_) {
        put_layer(z + dz, inside, voxels, dz);
      }
    }
    return all_fill(voxels) ? Bytes{} : codec_.encode(voxels);
  }

  void put_layer(int z, const cv::Rect& inside, Bytes& voxels, int dz) const {
    const std::size_t voxel = layers_.front().elemSize();
    const std::size_t row_bytes = static_cast<std::size_t>(layout_.chunk[2]) * voxel;
    const std::size_t layer_bytes = static_cast<std::size_t>(layout_.chunk[1]) * row_bytes;
    std::byte* out = voxels.data() + static_cast<std::size_t>(dz) * layer_bytes;
    if (z >= end()) {
      std::memset(out, 0, layer_bytes);
      return;
    }
    const cv::Mat& layer = layers_[static_cast<std::size_t>(z - first_)];
    for (int y = 0; y < inside.height; ++y) {
      std::memcpy(out + static_cast<std::size_t>(y) * row_bytes,
                  layer.ptr(inside.y + y) + static_cast<std::size_t>(inside.x) * voxel,
                  static_cast<std::size_t>(inside.width) * voxel);
    }
  }

  const VolumeLayout& layout_;
  ChunkCodec codec_;
  BlockCount count_;
  int first_;  // within the shard
  const std::vector<cv::Mat>& layers_;
  const std::optional<StoredShard>& before_;
};

}  // namespace

std::vector<ZarrArray> level_arrays(const ZarrArray& finest,
                                    const std::vector<LevelFactor>& factors) {
  std::vector<ZarrArray> arrays;
  for (const LevelFactor& factor : factors) {
    arrays.push_back(finest);
    arrays.back().size = pyramid_level({finest.size, {1.0, 1.0, 1.0}}, factor).size;
  }
  return arrays;
}

/// One band on its way through the levels.
class PyramidWriter::BandOfLevels {
 public:
  BandOfLevels(const PyramidWriter& writer, const LayerRange& finest, const BandRegions& band)
      : writer_(writer), band_(band) {
    for (const LevelFactor& factor : writer.factors_) {
      ranges_.push_back(layers_of_level(finest, factor));
    }
  }

  void write() {
    const std::size_t coarsest = writer_.arrays_.size() - 1;
    const BlockCount shards = shards_of(writer_.arrays_[coarsest]);
    for (std::int64_t y = 0; y < shards.y; ++y) {
      for (std::int64_t x = 0; x < shards.x; ++x) {
        write_shard(coarsest, y, x);
      }
    }
    disk_.finish();
  }

 private:
  cv::Rect region(std::size_t level, std::int64_t y, std::int64_t x) const {
    const ZarrArray& array = writer_.arrays_[level];
    const auto& shard = array.layout.shard;
    return cv::Rect(static_cast<int>(x) * shard[2], static_cast<int>(y) * shard[1], shard[2],
                    shard[1]) &
           cv::Rect(0, 0, static_cast<int>(array.size.x), static_cast<int>(array.size.y));
  }

  fs::path shard_path(std::size_t level, std::int64_t z, std::int64_t y, std::int64_t x) const {
    return writer_.volume_ / level_path(static_cast<int>(level)) / shard_key(z, y, x);
  }

  /// A shard that holds layers of earlier bands.
  std::optional<StoredShard> stored_shard(std::size_t level, std::int64_t z, std::int64_t y,
                                          std::int64_t x) const {
    const fs::path path = shard_path(level, z, y, x);
    std::optional<StoredShard> shard = StoredShard::open(path, writer_.arrays_[level]);
    if (!shard && writer_.every_shard_) {
      throw SampleError(path.string() + ": " + kIsMissing);
    }
    return shard;
  }

  /// Writes the shard, after those of the finer levels that it covers. Returns the band's layers of
  /// its region, for the next coarser level.
  std::vector<cv::Mat> write_shard(std::size_t level, std::int64_t y, std::int64_t x) {
    std::vector<cv::Mat> layers =
        level == 0 ? band_(region(level, y, x)) : means_of_covered(level, y, x);
    const ZarrArray& array = writer_.arrays_[level];
    const LayerRange& range = ranges_[level];
    const std::int64_t z = range.first / array.layout.shard[0];
    std::optional<StoredShard> before;
    if (range.first % array.layout.shard[0] != 0) {
      before = stored_shard(level, z, y, x);
    }
    store(shard_path(level, z, y, x), ShardEncoder(array, range, layers, before).encode());
    return layers;
  }

  std::vector<cv::Mat> means_of_covered(std::size_t level, std::int64_t y, std::int64_t x) {
    const std::size_t finer = level - 1;
    const HalvedAxes axes = halved_axes(writer_.factors_[finer], writer_.factors_[level]);
    const BlockCount shards = shards_of(writer_.arrays_[finer]);
    const std::int64_t first_y = axes.y ? 2 * y : y;
    const std::int64_t first_x = axes.x ? 2 * x : x;
    const cv::Rect whole = region(level, y, x);
    std::vector<cv::Mat> layers(static_cast<std::size_t>(ranges_[level].count()));
    for (cv::Mat& layer : layers) {
      layer.create(whole.size(), writer_.arrays_[level].bits == 8 ? CV_8UC3 : CV_16UC3);
    }
    for (std::int64_t cy = first_y; cy <= first_y + (axes.y ? 1 : 0) && cy < shards.y; ++cy) {
      for (std::int64_t cx = first_x; cx <= first_x + (axes.x ? 1 : 0) && cx < shards.x; ++cx) {
        const std::vector<cv::Mat> means = level_mean(with_layer_before(finer, axes, cy, cx), axes);
        const cv::Point place = region(finer, cy, cx).tl();
        const cv::Rect part(
            cv::Point(place.x / (axes.x ? 2 : 1), place.y / (axes.y ? 2 : 1)) - whole.tl(),
            means.front().size());
        for (std::size_t k = 0; k < layers.size(); ++k) {
          means[k].copyTo(layers[k](part));
        }
      }
    }
    return layers;
  }

  /// The band's layers of a shard, and in front of them the last of the band before when the next
  /// level's first layer is the mean of both.
  std::vector<cv::Mat> with_layer_before(std::size_t level, const HalvedAxes& axes, std::int64_t y,
                                         std::int64_t x) {
    std::vector<cv::Mat> layers = write_shard(level, y, x);
    const std::int64_t first = ranges_[level].first;
    if (axes.z && first % 2 != 0) {
      const ZarrArray& array = writer_.arrays_[level];
      const std::int64_t depth = array.layout.shard[0];
      const std::vector<cv::Mat> last =
          shard_layers(stored_shard(level, (first - 1) / depth, y, x), array,
                       static_cast<int>((first - 1) % depth), 1, layers.front().size());
      layers.insert(layers.begin(), last.front());
    }
    return layers;
  }

  void store(const fs::path& path, FileParts shard) {
    std::size_t size = 0;
    for (const Bytes& part : shard) {
      size += part.size();
    }
    disk_.add(size, [path, parts = std::move(shard)] {
      create_folders_durably(path.parent_path());
      write_durably(path, parts);
    });
  }

  const PyramidWriter& writer_;
  const BandRegions& band_;
  std::vector<LayerRange> ranges_;
  WriteBehind disk_{kBytesBehind, kThreadsBehind};
};

PyramidWriter::PyramidWriter(fs::path volume, const ZarrArray& finest,
                             std::vector<LevelFactor> factors, bool every_shard)
    : volume_(std::move(volume)),
      factors_(std::move(factors)),
      arrays_(level_arrays(finest, factors_)),
      every_shard_(every_shard) {}

void PyramidWriter::write_band(std::int64_t first_layer, std::int64_t layer_count,
                               const BandRegions& band) {
  BandOfLevels(*this, {first_layer, first_layer + layer_count}, band).write();
}

}  // namespace biotomy::reconstruct
