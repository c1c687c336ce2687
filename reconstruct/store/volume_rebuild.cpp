#include "reconstruct/store/volume_rebuild.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "reconstruct/disk/folder_owner.hpp"
#include "reconstruct/disk/folder_swap.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/store/layer_band.hpp"
#include "reconstruct/store/layers_in_shards.hpp"
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

/// How many layers a volume says that it has; none where that cannot be read.
std::optional<std::int64_t> layers_shown(const fs::path& volume) {
  const fs::path path = volume / kMetadataName;
  try {
    return parse_group_metadata(read_metadata_file(path), path.string()).layers_present;
  } catch (const SampleError&) {
    return std::nullopt;
  }
}

/// The array of the finest level whose metadata can be read: levels differ in size alone.
std::optional<ZarrArray> readable_array(const fs::path& volume) {
  std::error_code error;
  for (int level = 0; fs::is_directory(volume / level_path(level), error); ++level) {
    const fs::path path = volume / level_path(level) / kMetadataName;
    try {
      return parse_array_metadata(read_metadata_file(path), path.string());
    } catch (const SampleError&) {
      continue;  // it is what the volume is made anew for
    }
  }
  return std::nullopt;
}

/// How many layers a volume without its metadata may hold: where not even one level says how deep
/// a shard is, as many as the sample is to have.
std::int64_t layers_held(const fs::path& volume, std::optional<ZarrArray> array,
                         const SampleFolder& sample) {
  const GridSize& size = sample.description().cuboid.size;
  if (!array) {
    return has_shards(volume) ? size.z : 0;
  }
  array->size = size;
  return layers_in_shards(volume, *array);
}

/// Throws SampleError when the volume holds more layers than there are files, of which it may be
/// the last copy.
void check_loses_no_layers(const SampleFolder& sample, const fs::path& volume,
                           const std::optional<ZarrArray>& array, std::int64_t layers) {
  std::error_code error;
  if (!fs::exists(volume, error) && !error) {
    return;
  }
  const std::optional<std::int64_t> shown = layers_shown(volume);
  const std::int64_t held = shown ? *shown : layers_held(volume, array, sample);
  if (held > layers) {
    throw SampleError(
        sample.layer_path(layers + 1).string() + ": is missing, and the volume " +
        (shown ? "shows " : "(whose zarr.json is missing or damaged) has shards for up to ") +
        std::to_string(held) + " layers, of which a rebuild would lose " +
        std::to_string(held - layers) + ": put the files back, or move " + volume.string() +
        " away to have a volume without them");
  }
}

/// Where a volume grows before it takes the place of the one that is there.
fs::path unfinished_volume(const SampleFolder& sample) {
  const fs::path place = sample.volume_path();
  return place.parent_path() / ("." + place.filename().string() + ".partial");
}

}  // namespace

std::int64_t rebuild_volume(const SampleFolder& sample,
                            const std::function<void(std::int64_t, std::int64_t)>& progress,
                            const StopRequested& stop) {
  const std::int64_t layers = count_layers(sample);
  const fs::path place = sample.volume_path();
  const fs::path fresh = unfinished_volume(sample);
  settle_replaced_folder(fresh, place);
  const std::optional<ZarrArray> array = readable_array(place);
  check_loses_no_layers(sample, place, array, layers);
  remove_folder(fresh);  // of a rebuild that was killed
  const UnfinishedFolder unfinished(fresh);
  VolumeWriter writer(sample, array ? array->layout : VolumeLayout(), fresh);
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
  give_to_owner_of(sample.path(), fresh);
  replace_folder(fresh, place);
  return layers;
}

std::vector<fs::path> left_by_rebuilds(const SampleFolder& sample) {
  std::vector<fs::path> left;
  const fs::path fresh = unfinished_volume(sample);
  for (const fs::path& folder : {fresh, name_aside(fresh)}) {
    std::error_code error;
    if (fs::exists(folder, error)) {
      left.push_back(folder);
    }
  }
  return left;
}

}  // namespace biotomy::reconstruct
