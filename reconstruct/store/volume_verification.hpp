#pragma once

#include <cstdint>

#include "reconstruct/sample/finding.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/sample/sample_growth.hpp"

namespace biotomy::reconstruct {

/// Looks a sample's volume through: the metadata of the group and of every level against each other
/// and the sample's description, the number of layers against the layer files, every shard's index,
/// every chunk decoded, files that do not belong there. With `deep` also every voxel of level 0
/// against the layer files, and every level against the means of the one before.
/// While the sample grows, the layers of one band more may be files alone: those of a band that is
/// on its way into the volume. A shard that differs then is compared again once the volume has the
/// next band.
/// Memory holds a few shards. Progress is in shards. Returns the number of shards.
std::int64_t verify_volume(const SampleFolder& sample, bool deep,
                           const VerificationListener& listener, const SampleGrowth& growth = {});

}  // namespace biotomy::reconstruct
