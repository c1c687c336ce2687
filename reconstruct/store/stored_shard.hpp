#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "reconstruct/disk/file_descriptor.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/zarr_array.hpp"

namespace biotomy::reconstruct {

/// A shard's file, open, with its index. Chunks are read when they are asked for: memory holds the
/// index and those, however long the file says it is. Chunks are numbered as in ShardIndex. Safe
/// for many threads. A shard that replaces the file meanwhile is not seen.
class StoredShard {
 public:
  /// None when there is no such file. Throws SampleError, naming the file, when it cannot be read
  /// or its index is damaged.
  static std::optional<StoredShard> open(const std::filesystem::path& path, const ZarrArray& array);

  /// False for a chunk that is all fill value.
  bool stores(std::size_t chunk) const { return index_.at(chunk).stored(); }

  /// As it is stored; empty when all of the chunk is fill value. Throws SampleError, naming the
  /// file.
  std::vector<std::byte> encoded(std::size_t chunk) const;

  /// Fills `voxels` (ChunkCodec::chunk_bytes()), with fill value where nothing is stored. Throws
  /// SampleError, naming the file and the chunk, when it is damaged.
  void decode(std::size_t chunk, const ChunkCodec& codec, std::span<std::byte> voxels) const;

 private:
  StoredShard(std::filesystem::path path, const BlockCount& chunks, FileDescriptor file);

  std::uint64_t size() const;
  void read(std::uint64_t offset, std::span<std::byte> out) const;

  std::filesystem::path path_;
  BlockCount chunks_;
  FileDescriptor file_;
  ShardIndex index_;
};

}  // namespace biotomy::reconstruct
