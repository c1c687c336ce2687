#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/store/pyramid.hpp"
#include "reconstruct/store/volume_layout.hpp"

namespace biotomy::reconstruct {

/// Which chunk of a level: voxel (x, y, z) lies in chunk (x / chunk[2], y / chunk[1], z /
/// chunk[0]).
struct ChunkIndex {
  std::int32_t z = 0;
  std::int32_t y = 0;
  std::int32_t x = 0;

  friend auto operator<=>(const ChunkIndex&, const ChunkIndex&) = default;
};

/// The voxels of one chunk, whole even at the border of the volume, colours R G B side by side:
/// byte (((z · chunk[1] + y) · chunk[2] + x) · 3 + c) · bytes per colour.
using ChunkVoxels = std::vector<std::byte>;

/// What reading has cost; counted by every reader of a volume.
struct ReadStatistics {
  std::atomic<std::int64_t> chunks_read{0};
  std::atomic<std::int64_t> bytes_read{0};
  std::atomic<std::int64_t> read_ns{0};
  std::atomic<std::int64_t> decode_ns{0};
};

/// The volume of a sample, opened for reading, while it may still grow.
/// Safe for many threads.
class Volume {
 public:
  /// Throws SampleError when it is not a volume that can be read.
  static Volume open(const std::filesystem::path& path);
  ~Volume();
  Volume(Volume&&) noexcept;

  const Cuboid& cuboid() const;  ///< of the whole job
  int levels() const;            ///< at least 1
  const PyramidLevel& level(int number) const;
  const VolumeLayout& layout() const;
  int bits() const;                     ///< of one colour, 8 or 16
  std::int64_t layers_present() const;  ///< as the metadata said when it was opened

  /// Reads and decodes one chunk of a level; one that was never written is null (all fill value).
  /// Throws SampleError on a damaged shard or chunk.
  std::shared_ptr<const ChunkVoxels> read_chunk(int level, ChunkIndex index) const;

  const ReadStatistics& statistics() const;

 private:
  struct State;
  explicit Volume(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::reconstruct
