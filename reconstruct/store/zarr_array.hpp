#pragma once

#include <cstdint>
#include <string>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/store/volume_layout.hpp"

namespace biotomy::reconstruct {

/// One level of a volume as a Zarr v3 array: shape [3, z, y, x], regular chunk grid of shards,
/// codec `sharding_indexed` around the codecs of the inner chunks, fill value 0.
struct ZarrArray {
  GridSize size;
  int bits = 8;
  VolumeLayout layout;

  friend bool operator==(const ZarrArray&, const ZarrArray&) = default;
};

/// Numbers of shards, or of chunks in a shard, along z, y and x.
struct BlockCount {
  std::int64_t z = 0;
  std::int64_t y = 0;
  std::int64_t x = 0;

  std::int64_t total() const { return z * y * x; }
  bool operator==(const BlockCount&) const = default;
};
BlockCount shards_of(const ZarrArray& array);
BlockCount chunks_of_shard(const VolumeLayout& layout);

/// The text of the array's `zarr.json`.
std::string array_metadata(const ZarrArray& array);

/// Understands the arrays that array_metadata writes, also when another program has written them
/// anew in other words for the same. Throws SampleError, which begins with `name`, on anything
/// else.
ZarrArray parse_array_metadata(const std::string& text, const std::string& name);

/// The name of a shard below its array: `c/0/Z/Y/X` (the three colours are one chunk).
std::string shard_key(std::int64_t z, std::int64_t y, std::int64_t x);

}  // namespace biotomy::reconstruct
