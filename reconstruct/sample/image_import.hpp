#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <variant>

#include "reconstruct/geometry/vector3.hpp"
#include "reconstruct/sample/image_sequence.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/volume_layout.hpp"

namespace biotomy::reconstruct {

/// Distances between the centres of neighbouring voxels, micrometres.
struct VoxelSpacing {
  Vector3 um;
};

/// Size of the whole stack, micrometres, counted from the outer side of the first voxel to that of
/// the last: the spacing is the size divided by the number of voxels.
struct StackSize {
  Vector3 um;
};

struct ImportRequest {
  std::filesystem::path output;  ///< the sample folder; must not exist, or be empty
  std::string name;
  std::string notes;
  std::string created;  ///< ISO 8601, UTC
  std::variant<VoxelSpacing, StackSize> scale;
  LayerFormat layer_format;
  VolumeLayout layout;
};

/// Layers done of all.
using ImportProgress = std::function<void(std::int64_t done, std::int64_t total)>;

/// Makes a sample from photographs: the layer images and the volume. Nothing is seen at `output`
/// until all of it is there: it grows in a hidden folder beside, which is removed when something
/// goes wrong. Holds a fixed number of images and a few shards in memory.
/// Throws InvalidRequest or SampleError.
SampleFolder import_images(const ImageSequence& images, const ImportRequest& request,
                           const ImportProgress& progress = {});

}  // namespace biotomy::reconstruct
