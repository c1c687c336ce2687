#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "reconstruct/store/zarr_array.hpp"
#include "tests/bench/section_pixels.hpp"

namespace biotomy::bench {

/// Where the encoded bytes of one chunk lie.
struct ChunkBytes {
  std::size_t file = 0;  ///< of ChunkRanges::files
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
};

/// The stored chunks among some places, in the order of their files and offsets.
struct ChunkRanges {
  std::vector<std::filesystem::path> files;
  std::vector<ChunkBytes> chunks;

  std::uint64_t bytes() const;
};

/// Looks the places, which are in order, up in the shards' indexes; chunks that are not stored are
/// left out. `level` is the folder of the level's array. Throws SampleError, which names the shard,
/// when one is damaged.
ChunkRanges find_chunks(const std::filesystem::path& level, const reconstruct::ZarrArray& array,
                        const std::vector<ChunkPlace>& places);

}  // namespace biotomy::bench
