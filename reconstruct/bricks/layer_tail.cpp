#include "reconstruct/bricks/layer_tail.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <utility>

#include <oneapi/tbb/task_arena.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/layer_band.hpp"
#include "reconstruct/store/level_mean.hpp"
#include "reconstruct/store/volume_misfit.hpp"
#include "reconstruct/whole_loop.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr std::int64_t kTile = 256;  // pixels of a side that are decoded together, as in the images
constexpr std::int64_t kLayersAtOnce = 32;

std::int64_t divide_up(std::int64_t size, std::int64_t factor) {
  return (size + factor - 1) / factor;
}

/// How many of something of `size` lie side by side in a tile, or one if it is larger.
std::int64_t of_a_tile(std::int64_t size) {
  return std::max(kTile / size, std::int64_t{1});
}

int round_down(int value, int unit) {
  return value / unit * unit;
}

/// The pieces of `region` that a grid of `size` cuts it into.
std::vector<cv::Rect> pieces_of(const cv::Rect& region, const cv::Size& size) {
  std::vector<cv::Rect> pieces;
  for (int y = round_down(region.y, size.height); y < region.br().y; y += size.height) {
    for (int x = round_down(region.x, size.width); x < region.br().x; x += size.width) {
      pieces.push_back(cv::Rect(cv::Point(x, y), size) & region);
    }
  }
  return pieces;
}

}  // namespace

/// Chunks of one depth that lie above the same tiles.
class LayerTail::Block {
 public:
  Block(const LayerTail& tail, int level, std::span<const ChunkIndex> wanted,
        std::vector<std::size_t> members)
      : tail_(tail), level_(level), wanted_(wanted), members_(std::move(members)) {
    const std::int64_t depth = tail.volume_.layout().chunk[0];
    const LayerRange changed = tail.changed_layers(level);
    top_ = wanted[members_.front()].z * depth;
    range_ = {std::max(top_, changed.first), std::min(top_ + depth, changed.end)};
    for (const std::size_t which : members_) {
      region_ |= place(which);
    }
  }

  void read(const Volume::OnChunk& on_chunk) {
    for (const std::size_t which : members_) {
      voxels_.push_back(start_of(which));
    }
    const LevelFactor& factor = tail_.volume_.level(level_).factor;
    const std::vector<cv::Rect> pieces = pieces_of(
        region_,
        cv::Size(static_cast<int>(of_a_tile(factor.x)), static_cast<int>(of_a_tile(factor.y))));
    const std::int64_t step = std::max(kLayersAtOnce / factor.z, std::int64_t{1});
    whole_loop(pieces.size(), [&](std::size_t number) {
      // Who waits for the loops within goes on with those alone, not with more pieces on top.
      tbb::this_task_arena::isolate([&] {
        for (std::int64_t first = range_.first; first < range_.end; first += step) {
          put({first, std::min(first + step, range_.end)}, pieces[number]);
        }
      });
    });
    for (std::size_t i = 0; i < members_.size(); ++i) {
      on_chunk(members_[i], voxels_[i]);
    }
  }

 private:
  /// The chunk's part of the face, whole or not.
  cv::Rect place(std::size_t which) const {
    const auto& chunk = tail_.volume_.layout().chunk;
    return cv::Rect(wanted_[which].x * chunk[2], wanted_[which].y * chunk[1], chunk[2], chunk[1]) &
           tail_.face(level_);
  }

  /// The chunk without what the tail will lay over it.
  ChunkVoxels start_of(std::size_t which) const {
    if (top_ >= range_.first) {
      return tail_.empty_chunk();
    }
    ChunkVoxels voxels = tail_.stored_chunk(level_, wanted_[which]);
    const std::size_t layer_bytes =
        voxels.size() / static_cast<std::size_t>(tail_.volume_.layout().chunk[0]);
    std::fill(voxels.begin() + static_cast<std::ptrdiff_t>(
                                   layer_bytes * static_cast<std::size_t>(range_.first - top_)),
              voxels.end(), std::byte{0});
    return voxels;
  }

  void put(const LayerRange& range, const cv::Rect& piece) {
    const std::vector<cv::Mat> layers = tail_.layers(level_, range, piece);
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const cv::Rect chunk = place(members_[i]);
      const cv::Rect common = chunk & piece;
      if (common.empty()) {
        continue;
      }
      for (std::size_t k = 0; k < layers.size(); ++k) {
        cv::Mat out = tail_.layer_of(voxels_[i], range.first + static_cast<std::int64_t>(k));
        layers[k](common - piece.tl()).copyTo(out(common - chunk.tl()));
      }
    }
  }

  const LayerTail& tail_;
  int level_;
  std::span<const ChunkIndex> wanted_;
  std::vector<std::size_t> members_;
  std::int64_t top_ = 0;  // layer of the level
  LayerRange range_;      // that the tail has a part in
  cv::Rect region_;
  std::vector<ChunkVoxels> voxels_;
};

LayerTail::LayerTail(const SampleFolder& sample, const Volume& volume)
    : sample_(sample),
      volume_(volume),
      first_(volume.layers_present()),
      end_(first_ + sample.layers_on_disk(first_ + 1)) {
  if (end_ == first_) {
    return;
  }
  if (const auto what = misfit(volume.cuboid(), volume.bits(), sample)) {
    throw SampleError(sample.volume_path().string() + ": " + *what);
  }
}

/// Those that a layer of the tail has a part in.
LayerTail::LayerRange LayerTail::changed_layers(int level) const {
  const std::int64_t factor = volume_.level(level).factor.z;
  return {first_ / factor, divide_up(end_, factor)};
}

bool LayerTail::touches(int level, ChunkIndex chunk) const {
  return end_ > first_ &&
         (std::int64_t{chunk.z} + 1) * volume_.layout().chunk[0] > changed_layers(level).first;
}

void LayerTail::read_chunks(int level, std::span<const ChunkIndex> wanted,
                            const Volume::OnChunk& on_chunk,
                            const Volume::OnDamage& on_damage) const {
  const PyramidLevel& pyramid = volume_.level(level);
  const auto& chunk = volume_.layout().chunk;
  const std::int64_t across = of_a_tile(chunk[2] * pyramid.factor.x);
  const std::int64_t down = of_a_tile(chunk[1] * pyramid.factor.y);
  std::map<std::array<std::int64_t, 3>, std::vector<std::size_t>> members;
  for (std::size_t which = 0; which < wanted.size(); ++which) {
    const ChunkIndex& index = wanted[which];
    if (std::int64_t{index.z} * chunk[0] >= changed_layers(level).end) {
      on_chunk(which, {});  // below the newest face
    } else {
      members[{index.z, index.y / down, index.x / across}].push_back(which);
    }
  }
  std::vector<std::vector<std::size_t>> blocks;
  blocks.reserve(members.size());
  for (auto& [place, those] : members) {
    blocks.push_back(std::move(those));
  }
  whole_loop(blocks.size(), [&](std::size_t number) {
    tbb::this_task_arena::isolate([&] {
      try {
        Block(*this, level, wanted, blocks[number]).read(on_chunk);
      } catch (const SampleError& error) {
        if (!on_damage) {
          throw;
        }
        for (const std::size_t which : blocks[number]) {
          on_damage(which, error);
        }
      }
    });
  });
}

cv::Rect LayerTail::face(int level) const {
  const GridSize& size = volume_.level(level).size;
  return {0, 0, static_cast<int>(size.x), static_cast<int>(size.y)};
}

int LayerTail::type() const {
  return volume_.bits() == 8 ? CV_8UC3 : CV_16UC3;
}

ChunkVoxels LayerTail::empty_chunk() const {
  const auto& chunk = volume_.layout().chunk;
  return ChunkVoxels(static_cast<std::size_t>(chunk[0]) * static_cast<std::size_t>(chunk[1]) *
                     static_cast<std::size_t>(chunk[2]) * CV_ELEM_SIZE(type()));
}

ChunkVoxels LayerTail::stored_chunk(int level, ChunkIndex index) const {
  const auto voxels = volume_.read_chunk(level, index);
  return voxels ? *voxels : empty_chunk();
}

/// The layer of a level in its chunk's voxels, without a copy.
cv::Mat LayerTail::layer_of(ChunkVoxels& voxels, std::int64_t layer) const {
  const auto& chunk = volume_.layout().chunk;
  const std::size_t bytes = voxels.size() / static_cast<std::size_t>(chunk[0]);
  return {chunk[1], chunk[2], type(),
          voxels.data() + bytes * static_cast<std::size_t>(layer % chunk[0])};
}

/// `layer` is one that was in the volume, with all its neighbours that it is the mean of.
cv::Mat LayerTail::stored_layer(int level, std::int64_t layer, const cv::Rect& region) const {
  const auto& chunk = volume_.layout().chunk;
  cv::Mat result(region.size(), type());
  for (const cv::Rect& part : pieces_of(region, cv::Size(chunk[2], chunk[1]))) {
    const ChunkIndex index{static_cast<std::int32_t>(layer / chunk[0]), part.y / chunk[1],
                           part.x / chunk[2]};
    ChunkVoxels voxels = stored_chunk(level, index);
    const cv::Point corner(index.x * chunk[2], index.y * chunk[1]);
    layer_of(voxels, layer)(part - corner).copyTo(result(part - region.tl()));
  }
  return result;
}

/// Of level 0, from 0.
cv::Mat LayerTail::image(std::int64_t layer, const cv::Rect& region) const {
  return LayerBand(sample_, layer + 1, 1).read(region).front();
}

/// A region of layers in which the tail has a part, as the pyramid's writer would make them: level
/// by level, each from the rounded one before.
std::vector<cv::Mat> LayerTail::layers(int level, const LayerRange& range,
                                       const cv::Rect& region) const {
  std::vector<cv::Mat> result;
  if (level == 0) {
    result.resize(static_cast<std::size_t>(range.end - range.first));
    whole_loop(result.size(), [&](std::size_t i) {
      result[i] = image(range.first + static_cast<std::int64_t>(i), region);
    });
    return result;
  }
  const int finer = level - 1;
  const HalvedAxes axes = halved_axes(volume_.level(finer).factor, volume_.level(level).factor);
  const int x = axes.x ? 2 : 1;
  const int y = axes.y ? 2 : 1;
  const cv::Rect covered =
      cv::Rect(x * region.x, y * region.y, x * region.width, y * region.height) & face(finer);
  const LayerRange changed = changed_layers(finer);
  LayerRange sources = range;
  if (axes.z) {
    sources = {2 * range.first, std::min(2 * range.end, changed.end)};
  }
  for (; sources.first < changed.first; ++sources.first) {  // at most one, the tail's neighbour
    result.push_back(stored_layer(finer, sources.first, covered));
  }
  std::vector<cv::Mat> made = layers(finer, sources, covered);
  std::move(made.begin(), made.end(), std::back_inserter(result));
  return level_mean(result, axes);
}

}  // namespace biotomy::reconstruct
