#include "reconstruct/store/volume_writer.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/store/layer_band.hpp"
#include "reconstruct/store/metadata_text.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/volume_misfit.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

fs::path array_path(const fs::path& volume, std::size_t level) {
  return volume / level_path(static_cast<int>(level)) / kMetadataName;
}

// Two neighbours that a level takes the mean of must lie in one shard.
void check_shards_halve(const ZarrArray& array) {
  const auto& shard = array.layout.shard;
  if ((shard[2] % 2 != 0 && array.size.x > shard[2]) ||
      (shard[1] % 2 != 0 && array.size.y > shard[1])) {
    throw InvalidRequest("shard " + std::to_string(shard[2]) + "," + std::to_string(shard[1]) +
                         "," + std::to_string(shard[0]) +
                         " (x,y,z): its width and height must be even, as each level halves the "
                         "one before");
  }
}

}  // namespace

VolumeWriter::VolumeWriter(const SampleFolder& sample, const VolumeLayout& layout)
    : VolumeWriter(sample, layout, sample.volume_path()) {}

VolumeWriter::VolumeWriter(const SampleFolder& sample, const VolumeLayout& layout,
                           const fs::path& volume)
    : sample_(sample),
      volume_(volume),
      array_{sample.description().cuboid.size, sample.description().bits, layout} {
  check_layout(layout);
  remove_unfinished_writes(volume_);
  sync_folders(volume_);
  if (fs::exists(volume_ / kMetadataName)) {
    open();
  } else {
    create();
  }
}

void VolumeWriter::create() {
  check_shards_halve(array_);
  factors_ = pyramid_factors(sample_.description().cuboid, array_.layout.chunk);
  every_shard_ = true;
  const std::vector<ZarrArray> arrays = level_arrays(array_, factors_);
  for (std::size_t level = 0; level < arrays.size(); ++level) {
    const fs::path path = array_path(volume_, level);
    create_folders_durably(path.parent_path());
    write_durably(path, array_metadata(arrays[level]));
  }
  write_group(0);  // last: where there is a group there are its arrays
}

void VolumeWriter::open() {
  const fs::path group_path = volume_ / kMetadataName;
  const VolumeMetadata group =
      parse_group_metadata(read_metadata_file(group_path), group_path.string());
  const fs::path finest_path = array_path(volume_, 0);
  const ZarrArray finest =
      parse_array_metadata(read_metadata_file(finest_path), finest_path.string());
  const SampleDescription& description = sample_.description();
  if (const auto what = misfit({finest.size, group.spacing}, finest.bits, sample_)) {
    throw SampleError(volume_.string() + ": " + *what);
  }
  if (group.layers_present > finest.size.z) {
    throw SampleError(volume_.string() + ": does not fit the sample's description: it shows " +
                      std::to_string(group.layers_present) + " layers, of " +
                      std::to_string(finest.size.z) + "; build it anew: biotomy rebuild " +
                      sample_.path().string());
  }
  array_ = finest;
  factors_ = pyramid_factors(description.cuboid, array_.layout.chunk);
  if (group.levels != factors_) {
    throw SampleError(volume_.string() + ": has not the levels that it must have; build it anew: " +
                      "biotomy rebuild " + sample_.path().string());
  }
  check_shards_halve(array_);
  layers_written_ = group.layers_present;
  every_shard_ = group.every_shard;
}

void VolumeWriter::write_group(std::int64_t layers_present) const {
  const SampleDescription& description = sample_.description();
  VolumeMetadata metadata;
  metadata.name = description.name;
  metadata.spacing = description.cuboid.spacing;
  metadata.bits = description.bits;
  metadata.levels = factors_;
  metadata.layers_present = layers_present;
  metadata.every_shard = every_shard_;
  write_durably(volume_ / kMetadataName, group_metadata(metadata));
}

void VolumeWriter::take_back_to(std::int64_t layers) {
  const std::int64_t kept = layers / band_depth() * band_depth();
  if (kept < layers_written_) {
    write_group(kept);
    layers_written_ = kept;
  }
}

void VolumeWriter::append_band(std::int64_t layer_count, const BandRegions& band) {
  const std::int64_t first = next_band();
  PyramidWriter(volume_, array_, factors_, every_shard_).write_band(first, layer_count, band);
  write_group(first + layer_count);
  layers_written_ = first + layer_count;
}

void VolumeWriter::append(std::int64_t layers_available, bool finish,
                          const std::function<void(std::int64_t)>& progress) {
  const std::int64_t layers_of_job = array_.size.z;
  const std::int64_t available = std::min(layers_available, layers_of_job);
  while (layers_written_ < available) {
    const std::int64_t first = next_band();
    const std::int64_t end = std::min(first + band_depth(), layers_of_job);
    if (end > available && !finish) {
      return;
    }
    const std::int64_t count = std::min(end, available) - first;
    const LayerBand band(sample_, first + 1, count);
    append_band(count, [&](const cv::Rect& region) { return band.read(region); });
    if (progress) {
      progress(layers_written_);
    }
  }
}

}  // namespace biotomy::reconstruct
