#include "acquisition/service/store_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "acquisition/service/configuration_keys.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/store/codecs.hpp"

namespace biotomy::acquisition {
namespace {

using bridge::CheckedTable;
using bridge::NumbersKey;
using bridge::TextKey;

/// Voxels along x, y and z; in the layout they stand in the order z, y, x.
std::array<int, 3> voxels(const CheckedTable& table, const char* name,
                          const std::array<int, 3>& fallback, const char* description) {
  const std::vector<double> sizes =
      table.get(NumbersKey{.name = name,
                           .fallback = std::vector<double>(fallback.rbegin(), fallback.rend()),
                           .unit = "voxels",
                           .minimum = 1,
                           .maximum = 16384,
                           .count = 3,
                           .description = description});
  std::array<int, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double size = sizes[2 - axis];
    if (size != std::floor(size)) table.reject(name, "expected whole numbers of voxels");
    result[axis] = static_cast<int>(size);
  }
  return result;
}

reconstruct::VolumeLayout read_volume_layout(const CheckedTable& table) {
  reconstruct::VolumeLayout layout;
  layout.codec = table.get(TextKey{.name = "codec",
                                   .fallback = layout.codec,
                                   .choices = reconstruct::codec_names(),
                                   .description = "of the volume's chunks"});
  layout.interleaved =
      table.get(TextKey{.name = "colours",
                        .fallback = layout.interleaved ? "interleaved" : "planar",
                        .choices = {"interleaved", "planar"},
                        .description = "in a chunk of the volume: voxel by voxel, or plane by "
                                       "plane"}) == "interleaved";
  layout.chunk =
      voxels(table, "chunk", layout.chunk, "what is compressed together in the volume, [x, y, z]");
  layout.shard = voxels(table, "shard", layout.shard,
                        "one file of the volume, a multiple of chunk, [x, y, z]; z is the number "
                        "of layers of a band");
  try {
    reconstruct::check_layout(layout);
  } catch (const reconstruct::InvalidRequest& error) {
    table.reject("codec, chunk and shard", error.what());
  }
  return layout;
}

}  // namespace

StorePlan read_store(const CheckedTable& table) {
  StorePlan store;
  const std::string compression = table.get(TextKey{.name = "compression",
                                                    .fallback = "zstd",
                                                    .choices = {"zstd", "deflate"},
                                                    .description = "of the layer images"});
  store.layer_format.compression = compression == "deflate" ? reconstruct::LayerCompression::deflate
                                                            : reconstruct::LayerCompression::zstd;
  store.layer_format.level =
      count(table, "level", store.layer_format.level, 1, 9, "of the compression");
  store.volume_layout = read_volume_layout(table);
  store.rejected_frames = count(table, "rejected_frames", store.rejected_frames, 1, 1000000,
                                "pictures of rejected frames that are kept; the oldest go");
  store.rejected_width_px =
      count(table, "rejected_width_px", store.rejected_width_px, 16, 10000, "their longer side");
  return store;
}

}  // namespace biotomy::acquisition
