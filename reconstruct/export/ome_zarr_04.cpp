#include "reconstruct/export/ome_zarr_04.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <vector>

#include <blosc.h>
#include <nlohmann/json.hpp>
#include <oneapi/tbb/parallel_for.h>
#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/export/unfinished_export.hpp"
#include "reconstruct/export/volume_block.hpp"
#include "reconstruct/export/voxel_region.hpp"

namespace biotomy::reconstruct {
namespace {

namespace fs = std::filesystem;

using nlohmann::json;

constexpr int kChunk = 64;
constexpr int kColours = 3;
constexpr int kBloscLevel = 5;
constexpr const char* kCompressor = "lz4";

/// A level as it is exported.
struct ExportedLevel {
  int level = 0;
  VoxelRegion region;
  PyramidLevel place;

  std::int64_t chunks(const VoxelRange& range) const {
    return (range.count() + kChunk - 1) / kChunk;
  }
  std::int64_t blocks() const { return chunks(region.z) * chunks(region.y) * chunks(region.x); }
};

json array_json(const ExportedLevel& level, int bits) {
  const GridSize size = level.region.size();
  return {{"zarr_format", 2},
          {"shape", {kColours, size.z, size.y, size.x}},
          {"chunks", {1, kChunk, kChunk, kChunk}},
          {"dtype", bits == 8 ? "|u1" : "<u2"},
          {"compressor",
           {{"id", "blosc"},
            {"cname", kCompressor},
            {"clevel", kBloscLevel},
            {"shuffle", BLOSC_SHUFFLE},
            {"blocksize", 0}}},
          {"fill_value", 0},
          {"order", "C"},
          {"filters", nullptr},
          {"dimension_separator", "/"}};
}

json dataset_json(const ExportedLevel& level, std::size_t number) {
  const Vector3& scale = level.place.spacing;
  const Vector3 corner =
      level.place.origin + Vector3{static_cast<double>(level.region.x.first) * scale.x,
                                   static_cast<double>(level.region.y.first) * scale.y,
                                   static_cast<double>(level.region.z.first) * scale.z};
  return {{"path", std::to_string(number)},
          {"coordinateTransformations",
           {{{"type", "scale"}, {"scale", {1.0, scale.z, scale.y, scale.x}}},
            {{"type", "translation"}, {"translation", {0.0, corner.z, corner.y, corner.x}}}}}};
}

json group_json(const std::vector<ExportedLevel>& levels, const std::string& name, int bits) {
  json datasets = json::array();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    datasets.push_back(dataset_json(levels[i], i));
  }
  json axes = json::array({{{"name", "c"}, {"type", "channel"}}});
  for (const char* axis : {"z", "y", "x"}) {
    axes.push_back({{"name", axis}, {"type", "space"}, {"unit", "micrometer"}});
  }
  const int highest = (1 << bits) - 1;
  json channels = json::array();
  for (const auto& [label, colour] :
       {std::pair("red", "FF0000"), std::pair("green", "00FF00"), std::pair("blue", "0000FF")}) {
    channels.push_back(
        {{"label", label},
         {"color", colour},
         {"active", true},
         {"window", {{"min", 0}, {"max", highest}, {"start", 0}, {"end", highest}}}});
  }
  return {{"multiscales", json::array({{{"version", "0.4"},
                                        {"name", name},
                                        {"axes", axes},
                                        {"datasets", datasets},
                                        {"type", "mean"},
                                        {"metadata",
                                         {{"method", "mean of neighbouring voxels"},
                                          {"version", "Biotomy " BIOTOMY_VERSION}}}}})},
          {"omero", {{"channels", channels}, {"rdefs", {{"model", "color"}}}}}};
}

void write_json(const fs::path& path, const json& content) {
  const std::string text = content.dump(2) + "\n";
  write_plainly(path, text.data(), text.size());
}

std::vector<ExportedLevel> exported_levels(const Volume& volume, const ExportRequest& request) {
  const VoxelRegion region = exported_region(volume, request);
  std::vector<ExportedLevel> levels;
  for (int level = request.level; level < volume.levels(); ++level) {
    levels.push_back({level,
                      region_of_level(region, volume.level(request.level), volume.level(level)),
                      volume.level(level)});
  }
  return levels;
}

/// The chunks of the three colours at one place.
class BlockWriter {
 public:
  BlockWriter(const Volume& volume, const ExportedLevel& level, fs::path folder)
      : volume_(volume), level_(level), folder_(std::move(folder)) {}

  void write(std::int64_t block) const {
    const std::int64_t across = level_.chunks(level_.region.x);
    const std::int64_t down = level_.chunks(level_.region.y);
    const std::array<std::int64_t, 3> place{block / (across * down), block / across % down,
                                            block % across};
    const auto part = [](const VoxelRange& range, std::int64_t number) {
      const std::int64_t first = range.first + number * kChunk;
      return VoxelRange{first, std::min(first + kChunk, range.end)};
    };
    const std::vector<cv::Mat> layers =
        read_block(volume_, level_.level,
                   {part(level_.region.x, place[2]), part(level_.region.y, place[1]),
                    part(level_.region.z, place[0])});
    for (int colour = 0; colour < kColours; ++colour) {
      write_colour(layers, colour, place);
    }
  }

 private:
  void write_colour(const std::vector<cv::Mat>& layers, int colour,
                    const std::array<std::int64_t, 3>& place) const {
    const int depth = layers.front().depth();
    const std::size_t value = layers.front().elemSize1();
    std::vector<std::byte> plane(std::size_t{kChunk} * kChunk * kChunk * value);
    for (std::size_t z = 0; z < layers.size(); ++z) {
      cv::Mat whole(kChunk, kChunk, depth, plane.data() + z * kChunk * kChunk * value);
      cv::Mat inside = whole(cv::Rect(cv::Point(0, 0), layers[z].size()));
      cv::extractChannel(layers[z], inside, colour);
    }
    if (std::all_of(plane.begin(), plane.end(), [](std::byte b) { return b == std::byte{0}; })) {
      return;
    }
    std::vector<std::byte> encoded(plane.size() + BLOSC_MAX_OVERHEAD);
    const int size =
        blosc_compress_ctx(kBloscLevel, BLOSC_SHUFFLE, value, plane.size(), plane.data(),
                           encoded.data(), encoded.size(), kCompressor, 0, 1);
    if (size <= 0) {
      throw SampleError("Blosc cannot compress a chunk");
    }
    const fs::path folder =
        folder_ / std::to_string(colour) / std::to_string(place[0]) / std::to_string(place[1]);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
      throw SampleError(folder.string() + ": cannot create this folder: " + error.message());
    }
    write_plainly(folder / std::to_string(place[2]), encoded.data(),
                  static_cast<std::size_t>(size));
  }

  const Volume& volume_;
  const ExportedLevel& level_;
  fs::path folder_;
};

}  // namespace

void export_ome_zarr_04(const Volume& volume, const std::string& name,
                        const ExportRequest& request) {
  const std::vector<ExportedLevel> levels = exported_levels(volume, request);
  std::int64_t total = 0;
  for (const ExportedLevel& level : levels) {
    total += level.blocks();
  }
  UnfinishedExport unfinished(request.output);
  write_json(unfinished.folder() / ".zgroup", {{"zarr_format", 2}});
  write_json(unfinished.folder() / ".zattrs", group_json(levels, name, volume.bits()));
  std::mutex mutex;
  std::int64_t done = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const fs::path folder = unfinished.folder() / std::to_string(i);
    fs::create_directory(folder);
    write_json(folder / ".zarray", array_json(levels[i], volume.bits()));
    const BlockWriter writer(volume, levels[i], folder);
    tbb::parallel_for(std::int64_t{0}, levels[i].blocks(), [&](std::int64_t block) {
      stop_here_if(request.stop, "the export was interrupted; nothing is left of it");
      writer.write(block);
      const std::scoped_lock lock(mutex);
      if (request.progress) {
        request.progress(++done, total);
      }
    });
  }
  unfinished.finish();
}

}  // namespace biotomy::reconstruct
