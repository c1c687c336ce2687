#include "reconstruct/store/volume_layout.hpp"

#include <cstddef>

#include "reconstruct/errors.hpp"
#include "reconstruct/store/codecs.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr int kLongestChunkSide = 1024;
constexpr int kLongestShardSide = 16384;
constexpr std::int64_t kMostChunks = std::int64_t{1} << 20;       // of a shard: an index of 16 MiB
constexpr std::int64_t kMostChunkVoxels = std::int64_t{1} << 24;  // 48 to 96 MB decoded

std::string triple(const std::array<int, 3>& sizes) {
  return std::to_string(sizes[2]) + "," + std::to_string(sizes[1]) + "," + std::to_string(sizes[0]);
}

}  // namespace

void check_layout(const VolumeLayout& layout) {
  std::int64_t voxels = 1;
  std::int64_t chunks = 1;
  for (std::size_t axis = 0; axis < layout.chunk.size(); ++axis) {
    if (layout.chunk[axis] < 1 || layout.chunk[axis] > kLongestChunkSide) {
      throw InvalidRequest("chunk " + triple(layout.chunk) + " (x,y,z): each side must be 1 to " +
                           std::to_string(kLongestChunkSide) + " voxels");
    }
    if (layout.shard[axis] < 1 || layout.shard[axis] > kLongestShardSide ||
        layout.shard[axis] % layout.chunk[axis] != 0) {
      throw InvalidRequest("shard " + triple(layout.shard) +
                           " (x,y,z): each side must be a multiple of the chunk's (" +
                           triple(layout.chunk) + ") and at most " +
                           std::to_string(kLongestShardSide));
    }
    voxels *= layout.chunk[axis];
    chunks *= layout.shard[axis] / layout.chunk[axis];
  }
  if (voxels > kMostChunkVoxels) {
    throw InvalidRequest("chunk " + triple(layout.chunk) + " (x,y,z) holds more than " +
                         std::to_string(kMostChunkVoxels) + " voxels; choose a smaller one");
  }
  if (chunks > kMostChunks) {
    throw InvalidRequest("shard " + triple(layout.shard) + " (x,y,z) holds more than " +
                         std::to_string(kMostChunks) + " chunks of " + triple(layout.chunk) +
                         "; choose larger chunks or a smaller shard");
  }
  check_codec_name(layout.codec);
}

}  // namespace biotomy::reconstruct
