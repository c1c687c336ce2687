#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>

#include <nlohmann/json_fwd.hpp>

#include "reconstruct/geometry/vector3.hpp"
#include "reconstruct/import/image_sequence.hpp"
#include "reconstruct/sample/layer_image.hpp"
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

/// What is to become of a stack of images. Texts are UTF-8.
struct ImportRequest {
  std::filesystem::path output;  ///< the sample folder; must not exist, or be empty
  std::string name;
  std::string notes;
  std::string created;  ///< ISO 8601, UTC; an import that is taken up again keeps its first
  std::variant<VoxelSpacing, StackSize> scale;
  LayerFormat layer_format;
  VolumeLayout layout;
  bool restart = false;  ///< forget what an interrupted import of this output has done
  /// The images of a band are kept for the volume when they are no larger together (and two bands
  /// at a time when both are); otherwise the band is read again from its layer files.
  std::size_t most_band_bytes = std::size_t{1} << 30;
};

/// What an import was asked, in as much as it decides what the sample becomes: the images (path,
/// size, time of change) and the options. Throws SampleError when an image is gone.
nlohmann::json import_record(const ImageSequence& images, const ImportRequest& request);

/// In what an import that was begun is another than the one that is asked now; none when they are
/// the same. An image of a layer that is not stored yet may have been mended meanwhile.
std::optional<std::string> import_difference(
    const nlohmann::json& begun, const nlohmann::json& asked,
    const std::function<bool(std::int64_t layer)>& is_stored);

}  // namespace biotomy::reconstruct
