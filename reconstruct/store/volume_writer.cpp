#include "reconstruct/store/volume_writer.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <oneapi/tbb/parallel_for.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/durable_file.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/zarr_array.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

using Bytes = std::vector<std::byte>;

constexpr int kFullResolution = 0;
constexpr const char* kMetadataName = "zarr.json";

ZarrArray array_of(const SampleFolder& sample, const VolumeLayout& layout) {
  return {sample.description().cuboid.size, sample.description().bits, layout};
}

fs::path level_folder(const SampleFolder& sample) {
  return sample.volume_path() / level_path(kFullResolution);
}

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    throw SampleError(path.string() + ": cannot be opened");
  }
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Makes a folder and those above it, so that they are still there after a crash.
void create_folders_durably(const fs::path& folder) {
  if (fs::is_directory(folder)) {
    return;
  }
  create_folders_durably(folder.parent_path());
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) {
    throw SampleError(folder.string() + ": cannot create this folder: " + error.message());
  }
  sync_folder(folder.parent_path());
}

void write_group(const SampleFolder& sample, std::int64_t layers_present) {
  const SampleDescription& description = sample.description();
  VolumeMetadata metadata;
  metadata.name = description.name;
  metadata.spacing = description.cuboid.spacing;
  metadata.bits = description.bits;
  metadata.layers_present = layers_present;
  write_durably(sample.volume_path() / kMetadataName, group_metadata(metadata));
}

bool all_fill(std::span<const std::byte> bytes) {
  return bytes.empty() || (bytes[0] == std::byte{0} &&
                           std::memcmp(bytes.data(), bytes.data() + 1, bytes.size() - 1) == 0);
}

/// The layers of one band, opened.
class Band {
 public:
  Band(const SampleFolder& sample, std::int64_t first_layer, std::int64_t layer_count) {
    const SampleDescription& description = sample.description();
    const int type = description.bits == 8 ? CV_8UC3 : CV_16UC3;
    for (std::int64_t layer = first_layer; layer < first_layer + layer_count; ++layer) {
      const fs::path path = sample.layer_path(layer);
      auto reader = std::make_unique<LayerImageReader>(path);
      if (reader->width() != description.cuboid.size.x ||
          reader->height() != description.cuboid.size.y || reader->type() != type) {
        throw SampleError(
            path.string() + ": is " + std::to_string(reader->width()) + " × " +
            std::to_string(reader->height()) + " of " + (reader->type() == CV_8UC3 ? "8" : "16") +
            " bits, the sample is " + std::to_string(description.cuboid.size.x) + " × " +
            std::to_string(description.cuboid.size.y) + " of " + std::to_string(description.bits));
      }
      readers_.push_back(std::move(reader));
    }
  }

  /// The same region of each layer.
  std::vector<cv::Mat> read(const cv::Rect& region) const {
    std::vector<cv::Mat> layers(readers_.size());
    tbb::parallel_for(std::size_t{0}, readers_.size(),
                      [&](std::size_t i) { layers[i] = readers_[i]->read(region); });
    return layers;
  }

 private:
  std::vector<std::unique_ptr<LayerImageReader>> readers_;
};

/// The encoded chunk whose first voxel is (x, y) of layer z; empty when all of it is fill value.
/// What lies beyond the region or the last layer is fill value.
Bytes encode_chunk(const std::vector<cv::Mat>& layers, std::array<int, 3> chunk, int z, int y,
                   int x, const ChunkCodec& codec) {
  const cv::Size region = layers.front().size();
  if (z >= static_cast<int>(layers.size()) || y >= region.height || x >= region.width) {
    return {};
  }
  const std::size_t voxel = layers.front().elemSize();
  const auto columns = static_cast<std::size_t>(std::min(chunk[2], region.width - x));
  const std::size_t row_bytes = columns * voxel;
  Bytes voxels(codec.chunk_bytes());
  for (int dz = 0; dz < chunk[0] && z + dz < static_cast<int>(layers.size()); ++dz) {
    const cv::Mat& layer = layers[static_cast<std::size_t>(z) + static_cast<std::size_t>(dz)];
    for (int dy = 0; dy < chunk[1] && y + dy < region.height; ++dy) {
      const std::size_t row = static_cast<std::size_t>(dz) * static_cast<std::size_t>(chunk[1]) +
                              static_cast<std::size_t>(dy);
      std::memcpy(voxels.data() + row * static_cast<std::size_t>(chunk[2]) * voxel,
                  layer.ptr(y + dy) + static_cast<std::size_t>(x) * voxel, row_bytes);
    }
  }
  return all_fill(voxels) ? Bytes{} : codec.encode(voxels);
}

Bytes encode_region(const std::vector<cv::Mat>& layers, const VolumeLayout& layout,
                    const ChunkCodec& codec) {
  const BlockCount count = chunks_of_shard(layout);
  std::vector<Bytes> chunks(static_cast<std::size_t>(count.total()));
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
    const auto place = static_cast<std::int64_t>(i);
    chunks[i] = encode_chunk(layers, layout.chunk,
                             static_cast<int>(place / (count.x * count.y)) * layout.chunk[0],
                             static_cast<int>(place / count.x % count.y) * layout.chunk[1],
                             static_cast<int>(place % count.x) * layout.chunk[2], codec);
  });
  return encode_shard(chunks);
}

}  // namespace

VolumeWriter::VolumeWriter(const SampleFolder& sample, const VolumeLayout& layout)
    : sample_(sample), layout_(layout) {
  check_layout(layout);
  const fs::path group_path = sample.volume_path() / kMetadataName;
  const fs::path array_path = level_folder(sample) / kMetadataName;
  if (!fs::exists(group_path)) {
    create_folders_durably(level_folder(sample));
    write_durably(array_path, array_metadata(array_of(sample, layout)));
    write_group(sample, 0);  // last: where there is a group there is an array
    return;
  }
  const VolumeMetadata group = parse_group_metadata(read_text(group_path), group_path.string());
  const ZarrArray array = parse_array_metadata(read_text(array_path), array_path.string());
  const SampleDescription& description = sample.description();
  if (array.size != description.cuboid.size || array.bits != description.bits ||
      group.spacing != description.cuboid.spacing || group.layers_present > array.size.z) {
    throw SampleError(sample.volume_path().string() +
                      ": does not fit the sample's description; remove it and build it anew");
  }
  layout_ = array.layout;
  layers_written_ = group.layers_present;
}

void VolumeWriter::append(std::int64_t layers_available, bool finish,
                          const std::function<void(std::int64_t)>& progress) {
  const std::int64_t layers_of_job = sample_.description().cuboid.size.z;
  const std::int64_t available = std::min(layers_available, layers_of_job);
  while (layers_written_ < available) {
    const std::int64_t first = layers_written_ / band_depth() * band_depth();
    const std::int64_t end = std::min(first + band_depth(), layers_of_job);
    if (end > available && !finish) {
      return;
    }
    const std::int64_t count = std::min(end, available) - first;
    write_band(first, count);
    write_group(sample_, first + count);
    layers_written_ = first + count;
    if (progress) {
      progress(layers_written_);
    }
  }
}

void VolumeWriter::write_band(std::int64_t first_layer, std::int64_t layer_count) {
  const ZarrArray array = array_of(sample_, layout_);
  const ChunkCodec codec(layout_, array.bits);
  const BlockCount shards = shards_of(array);
  const Band band(sample_, first_layer + 1, layer_count);
  const cv::Rect face(0, 0, static_cast<int>(array.size.x), static_cast<int>(array.size.y));
  const std::int64_t shard_z = first_layer / band_depth();
  for (std::int64_t y = 0; y < shards.y; ++y) {
    for (std::int64_t x = 0; x < shards.x; ++x) {
      const cv::Rect region =
          cv::Rect(static_cast<int>(x) * layout_.shard[2], static_cast<int>(y) * layout_.shard[1],
                   layout_.shard[2], layout_.shard[1]) &
          face;
      const Bytes shard = encode_region(band.read(region), layout_, codec);
      const fs::path path = level_folder(sample_) / shard_key(shard_z, y, x);
      if (!shard.empty()) {
        create_folders_durably(path.parent_path());
        write_durably(path, shard);
      } else if (fs::remove(path)) {  // of a band that was interrupted
        sync_folder(path.parent_path());
      }
    }
  }
}

}  // namespace biotomy::reconstruct
