#pragma once

#include <cstdint>

#include "reconstruct/sample/finding.hpp"
#include "reconstruct/sample/sample_folder.hpp"

namespace biotomy::reconstruct {

/// Looks a sample's volume through: the metadata of the group and of every level against each other
/// and the sample's description, the number of layers against the layer files, every shard's index,
/// every chunk decoded, files that do not belong there. With `deep` also every voxel of level 0
/// against the layer files, and every level against the means of the one before.
/// Memory holds a few shards. Progress is in shards. Returns the number of shards.
std::int64_t verify_volume(const SampleFolder& sample, bool deep,
                           const VerificationListener& listener);

}  // namespace biotomy::reconstruct
