#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "reconstruct/geometry/vector3.hpp"
#include "reconstruct/store/pyramid.hpp"

namespace biotomy::reconstruct {

/// What the group of a volume says: OME-Zarr 0.5 (`attributes.ome`) for everybody, and
/// `attributes.biotomy` for what OME-Zarr has no word for.
struct VolumeMetadata {
  std::string name;
  Vector3 spacing;  ///< of level 0, micrometres
  int bits = 8;
  std::vector<LevelFactor> levels{{}};  ///< from level 0, whose factors are 1
  std::int64_t layers_present = 0;      ///< layers from 1 that hold what was photographed
  /// Every shard that has a part in these layers is stored, at every level and also when all of it
  /// is fill value: one that is missing was lost.
  bool every_shard = false;

  friend bool operator==(const VolumeMetadata&, const VolumeMetadata&) = default;
};

/// Layers of a level that those which are present have a part in.
std::int64_t layers_present_at(const VolumeMetadata& metadata, std::size_t level);

/// The name of a level's array below the group: its number.
std::string level_path(int level);

/// The text of the group's `zarr.json`.
std::string group_metadata(const VolumeMetadata& metadata);

/// Throws SampleError, which begins with `name`.
VolumeMetadata parse_group_metadata(const std::string& text, const std::string& name);

}  // namespace biotomy::reconstruct
