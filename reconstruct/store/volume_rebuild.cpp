#include "reconstruct/store/volume_rebuild.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "reconstruct/disk/folder_swap.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/store/layer_band.hpp"
#include "reconstruct/store/metadata_text.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/volume_writer.hpp"
#include "reconstruct/store/zarr_array.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

/// Removes an unfinished folder when its making ends with an exception.
class UnfinishedFolder {
 public:
  explicit UnfinishedFolder(fs::path path) : path_(std::move(path)) {}
  ~UnfinishedFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;

 private:
  fs::path path_;
};

/// Layers 1 to the one returned are there, and none after it.
std::int64_t count_layers(const SampleFolder& sample) {
  std::int64_t last = 0;
  std::int64_t missing = 0;  // the first
  for (std::int64_t layer = 1; layer <= sample.description().cuboid.size.z; ++layer) {
    std::error_code error;
    if (!fs::exists(sample.layer_path(layer), error)) {
      missing = missing == 0 ? layer : missing;
      continue;
    }
    if (missing != 0) {
      throw SampleError(sample.layer_path(missing).string() +
                        ": is missing and there are deeper layers; put it back first");
    }
    last = layer;
  }
  if (last == 0) {
    throw SampleError(sample.path().string() + ": has no layers to make a volume of");
  }
  return last;
}

/// What the volume that is there shows; 0 where there is none, or none that can be read.
std::int64_t layers_shown(const fs::path& volume) {
  const fs::path path = volume / kMetadataName;
  try {
    return parse_group_metadata(read_metadata_file(path), path.string()).layers_present;
  } catch (const SampleError&) {
    return 0;
  }
}

VolumeLayout layout_of(const fs::path& volume) {
  const fs::path path = volume / level_path(0) / kMetadataName;
  try {
    return parse_array_metadata(read_metadata_file(path), path.string()).layout;
  } catch (const SampleError&) {
    return {};  // there is none, or it is what the volume is made anew for
  }
}

}  // namespace

std::int64_t rebuild_volume(const SampleFolder& sample,
                            const std::function<void(std::int64_t, std::int64_t)>& progress,
                            const StopRequested& stop) {
  const std::int64_t layers = count_layers(sample);
  const fs::path place = sample.volume_path();
  if (const std::int64_t shown = layers_shown(place); shown > layers) {
    throw SampleError(sample.layer_path(layers + 1).string() +
                      ": is missing, and the volume shows " + std::to_string(shown) +
                      " layers, of which a rebuild would lose " + std::to_string(shown - layers) +
                      ": put the files back, or move " + place.string() +
                      " away to have a volume without them");
  }
  const fs::path fresh = place.parent_path() / ("." + place.filename().string() + ".partial");
  remove_folder(fresh);  // of a rebuild that was killed
  const UnfinishedFolder unfinished(fresh);
  VolumeWriter writer(sample, layout_of(place), fresh);
  while (writer.layers_written() < layers) {
    const std::int64_t first = writer.next_band();
    const std::int64_t count = std::min<std::int64_t>(writer.band_depth(), layers - first);
    const LayerBand band(sample, first + 1, count);
    writer.append_band(count, [&](const cv::Rect& region) {
      stop_here_if(stop, place.string() + ": the rebuild was interrupted; the volume is as before");
      return band.read(region);
    });
    if (progress) {
      progress(writer.layers_written(), layers);
    }
  }
  replace_folder(fresh, place);
  return layers;
}

}  // namespace biotomy::reconstruct
