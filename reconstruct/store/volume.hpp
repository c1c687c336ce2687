#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/object_reader.hpp"
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
  static Volume open(std::unique_ptr<ObjectReader> objects);  ///< wherever they are stored

  /// The sample's volume; one without any layers, of the default layout, when none has been begun.
  /// Throws SampleError also when it does not fit the sample's description.
  static Volume of_sample(const SampleFolder& sample);

  ~Volume();
  Volume(Volume&&) noexcept;

  const Cuboid& cuboid() const;                 ///< of the whole job
  int levels() const;                           ///< at least 1
  const PyramidLevel& level(int number) const;  ///< 0 to levels() − 1
  const VolumeLayout& layout() const;
  int bits() const;                     ///< of one colour, 8 or 16
  std::int64_t layers_present() const;  ///< as the metadata said when it was opened

  /// Reads and decodes one chunk of a level; one that was never written is null (all fill value).
  /// Throws SampleError on a damaged chunk or shard, and on a missing one when the metadata says
  /// that every shard is stored. `level` and `index` are of the volume.
  std::shared_ptr<const ChunkVoxels> read_chunk(int level, ChunkIndex index) const;

  /// Takes one of many chunks: `which` counts in the order of the indices asked for; `voxels` is
  /// laid out as ChunkVoxels and lasts as long as the call; empty for a chunk that was never
  /// written.
  using OnChunk = std::function<void(std::size_t which, std::span<const std::byte> voxels)>;
  using OnDamage = std::function<void(std::size_t which, const SampleError& error)>;

  /// Reads and decodes many chunks of a level, each index once. What lies side by side in a shard
  /// is read at once; chunks are decoded, and both functions called, on many threads and in any
  /// order. A chunk that is damaged goes to `on_damage`, or, without one, is thrown. Of a chunk
  /// that has `layers`, only these are sure to be decoded.
  void read_chunks(int level, std::span<const ChunkIndex> wanted, const OnChunk& on_chunk,
                   const OnDamage& on_damage = {}, std::span<const ChunkLayers> layers = {}) const;

  /// Whether to read some layers of a chunk may be less work than to read all.
  bool decodes_by_layers() const;

  /// These will be read soon: their bytes may be fetched from the disk meanwhile. Waits for no
  /// bytes of chunks, but reads the indexes of shards that were not read yet.
  void expect_chunks(int level, std::span<const ChunkIndex> soon) const;

  const ReadStatistics& statistics() const;

 private:
  struct State;
  explicit Volume(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace biotomy::reconstruct
