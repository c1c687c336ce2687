// Makes a sample of any size on disk that holds only the chunks which sections along given planes
// touch, and those around them: what a section through it costs is what it costs in the whole, for
// a hundredth of the disk. The metadata says that all layers are there, and does not claim that
// every shard is stored: what is not is fill value. Its colours are made up (made_up_tissue.hpp);
// those of coarser levels are voxels of level 0, not means.
//
//   scale_store --planes FILE [--only NAME] -o SAMPLE [--size 10000,5000,5000] [--spacing 20,20,20]
//               [--levels 0] [--noisy 0.05]

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <oneapi/tbb/parallel_for_each.h>

#include "reconstruct/disk/durable_file.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/pyramid.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/zarr_array.hpp"
#include "tests/bench/exit_code.hpp"
#include "tests/bench/made_up_tissue.hpp"
#include "tests/bench/named_planes.hpp"
#include "tests/bench/section_pixels.hpp"
#include "tests/reconstruct/whole_shard.hpp"

namespace {

namespace fs = std::filesystem;
using namespace biotomy::bench;
using namespace biotomy::reconstruct;
using Bytes = std::vector<std::byte>;

struct Options {
  std::string planes;
  std::string only;
  std::string output;
  std::vector<std::int64_t> size{10000, 5000, 5000};
  std::vector<double> spacing{20, 20, 20};
  std::vector<std::size_t> levels{0};
  double noisy = 0.05;
};

constexpr const char* kMetadataName = "zarr.json";
constexpr int kBits = 8;
constexpr int kMostVoxels = 1'000'000;  // along one axis
constexpr int kReach = 2;  // voxels around: what a wider kernel than the linear one would ask for

/// The places of one shard's chunks.
using Shards = std::map<ChunkPlace, std::vector<ChunkPlace>>;

double finest(const Vector3& spacing) {
  return std::min({spacing.x, spacing.y, spacing.z});
}

Shards by_shard(const std::vector<NamedPlane>& planes, const Cuboid& cuboid,
                const PyramidLevel& level, const VolumeLayout& layout) {
  std::vector<ChunkPlace> all;
  for (const NamedPlane& plane : planes) {
    const auto touched = touched_chunks(section_pixels(plane, cuboid, finest(level.spacing)), level,
                                        layout.chunk, kReach);
    std::vector<ChunkPlace> both;
    std::set_union(all.begin(), all.end(), touched.begin(), touched.end(),
                   std::back_inserter(both));
    all = std::move(both);
  }
  const BlockCount count = chunks_of_shard(layout);
  Shards shards;
  for (const ChunkPlace& chunk : all) {
    shards[{chunk.z / count.z, chunk.y / count.y, chunk.x / count.x}].push_back(chunk);
  }
  return shards;
}

/// What lies beyond the level's border is fill value, 0.
Bytes voxels_of(const ChunkPlace& chunk, const PyramidLevel& level, const std::array<int, 3>& shape,
                const MadeUpTissue& tissue) {
  const std::int64_t depth = shape[0];
  const std::int64_t height = shape[1];
  const std::int64_t width = shape[2];
  Bytes voxels(static_cast<std::size_t>(depth * height * width * 3));
  const std::int64_t columns = std::min(width, level.size.x - chunk.x * width);
  for (std::int64_t z = 0; z < std::min(depth, level.size.z - chunk.z * depth); ++z) {
    for (std::int64_t y = 0; y < std::min(height, level.size.y - chunk.y * height); ++y) {
      auto* out = reinterpret_cast<std::uint8_t*>(voxels.data()) + (z * height + y) * width * 3;
      const std::int64_t from_z = (chunk.z * depth + z) * level.factor.z;
      const std::int64_t from_y = (chunk.y * height + y) * level.factor.y;
      if (level.factor.x == 1) {
        tissue.row(chunk.x * width, from_y, from_z, columns, out);
        continue;
      }
      for (std::int64_t x = 0; x < columns; ++x) {
        tissue.row((chunk.x * width + x) * level.factor.x, from_y, from_z, 1, out + 3 * x);
      }
    }
  }
  return voxels;
}

struct Written {
  std::atomic<std::int64_t> chunks{0};
  std::atomic<std::int64_t> bytes{0};
};

void write_shards(const fs::path& folder, const Shards& shards, const PyramidLevel& level,
                  const VolumeLayout& layout, const MadeUpTissue& tissue, Written& written) {
  const BlockCount count = chunks_of_shard(layout);
  const ChunkCodec codec(layout, kBits);
  tbb::parallel_for_each(shards, [&](const Shards::value_type& shard) {
    const auto& [place, chunks] = shard;
    std::vector<Bytes> encoded(static_cast<std::size_t>(count.total()));
    for (const ChunkPlace& chunk : chunks) {
      const std::int64_t number =
          ((chunk.z % count.z) * count.y + chunk.y % count.y) * count.x + chunk.x % count.x;
      encoded[static_cast<std::size_t>(number)] =
          codec.encode(voxels_of(chunk, level, layout.chunk, tissue));
    }
    const Bytes bytes = whole_shard(encoded);
    const fs::path file = folder / shard_key(place.z, place.y, place.x);
    fs::create_directories(file.parent_path());
    write_durably(file, bytes);
    written.chunks += static_cast<std::int64_t>(chunks.size());
    written.bytes += static_cast<std::int64_t>(bytes.size());
  });
}

void run(const Options& options) {
  const std::vector<NamedPlane> planes = read_planes(options.planes, options.only);
  const MadeUpTissue tissue(options.noisy);
  const VolumeLayout layout;
  SampleDescription description;
  description.name = "made up";
  description.notes = "holds only what some planes touch";
  description.created = "2026-01-01T00:00:00Z";
  description.bits = kBits;
  description.cuboid = {{options.size[0], options.size[1], options.size[2]},
                        {options.spacing[0], options.spacing[1], options.spacing[2]}};
  const Cuboid& cuboid = description.cuboid;

  VolumeMetadata group;
  group.name = description.name;
  group.spacing = cuboid.spacing;
  group.bits = kBits;
  group.levels = pyramid_factors(cuboid, layout.chunk);
  group.layers_present = cuboid.size.z;
  for (const std::size_t level : options.levels) {
    if (level >= group.levels.size()) {
      throw InvalidRequest("--levels " + std::to_string(level) + ": there are levels 0 to " +
                           std::to_string(group.levels.size() - 1));
    }
  }
  std::vector<PyramidLevel> levels;
  std::vector<Shards> shards;  // of each level; found before anything is written
  for (const LevelFactor& factor : group.levels) {
    const auto held = std::count(options.levels.begin(), options.levels.end(), levels.size());
    levels.push_back(pyramid_level(cuboid, factor));
    shards.push_back(held != 0 ? by_shard(planes, cuboid, levels.back(), layout) : Shards{});
  }

  const SampleFolder sample = SampleFolder::create(options.output, description);
  Written written;
  for (std::size_t number = 0; number < levels.size(); ++number) {
    const fs::path folder = sample.volume_path() / level_path(static_cast<int>(number));
    fs::create_directories(folder);
    write_durably(folder / kMetadataName, array_metadata({levels[number].size, kBits, layout}));
    write_shards(folder, shards[number], levels[number], layout, tissue, written);
  }
  write_durably(sample.volume_path() / kMetadataName, group_metadata(group));
  std::cout << written.chunks << " chunks, " << written.bytes / 1'000'000 << " MB\n";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes a sample that holds only what sections along some planes touch."};
  Options options;
  app.add_option("--planes", options.planes, "File of planes, in voxels")->required();
  app.add_option("--only", options.only, "The plane of this name");
  app.add_option("-o,--output", options.output, "The sample folder to make")->required();
  app.add_option("--size", options.size, "Voxels: X,Y,Z")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::Range(1, kMostVoxels))
      ->capture_default_str();
  app.add_option("--spacing", options.spacing, "Micrometres: X,Y,Z")
      ->delimiter(',')
      ->expected(3)
      ->check(CLI::Range(0.001, 1e6))
      ->capture_default_str();
  app.add_option("--levels", options.levels, "Levels that hold anything")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--noisy", options.noisy, "Share of the voxels with noise, 0 to 1")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return exit_code_of("scale_store", [&] { run(options); });
}
