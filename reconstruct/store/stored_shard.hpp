#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/zarr_array.hpp"

namespace biotomy::reconstruct {

/// A shard's file, read whole. Chunks are numbered as in ShardIndex.
class StoredShard {
 public:
  /// None when there is no such file: all of it is fill value. Throws SampleError, naming the file,
  /// when it cannot be read or its index is damaged.
  static std::optional<StoredShard> read(const std::filesystem::path& path,
                                         const BlockCount& chunks);

  /// As it is stored; empty when all of the chunk is fill value.
  std::span<const std::byte> encoded(std::size_t chunk) const;

  /// Fills `voxels` (ChunkCodec::chunk_bytes()), with fill value where nothing is stored. Throws
  /// SampleError, naming the file and the chunk, when it is damaged.
  void decode(std::size_t chunk, const ChunkCodec& codec, std::span<std::byte> voxels) const;

 private:
  StoredShard(std::filesystem::path path, const BlockCount& chunks);

  std::filesystem::path path_;
  BlockCount chunks_;
  std::vector<std::byte> bytes_;
  ShardIndex index_;
};

}  // namespace biotomy::reconstruct
