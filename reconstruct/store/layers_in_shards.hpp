#pragma once

#include <cstdint>
#include <filesystem>

#include "reconstruct/store/zarr_array.hpp"

namespace biotomy::reconstruct {

/// Whether level 0 of a volume has any shard. Throws SampleError when that cannot be told.
bool has_shards(const std::filesystem::path& volume);

/// How many layers the shards of level 0 hold, for when the volume's metadata does not say so: down
/// to the deepest one of which a voxel is not 0, but never fewer than one of the deepest band, and
/// all of that band when a shard of it cannot be read. A shard at a time is looked at.
/// `finest` is level 0's array. Throws SampleError when the shards cannot be listed.
std::int64_t layers_in_shards(const std::filesystem::path& volume, const ZarrArray& finest);

}  // namespace biotomy::reconstruct
