// Cuts sections out of a raw RGB volume that is held in memory as decoded bricks, on the command
// line of the programs that it is measured against: so that all ratios come from one run.
// usage: section_peer VOL nx ny nz --planes FILE [--only NAME] [--reps N] [--warm N] [--threads T]
//        [--evict] [--interpolation KIND] [--out PREFIX]
// VOL: z, y, x, RGB of 8 bits. FILE: lines "name P0x P0y P0z P1x … P2z" in voxels; columns run
// along P1 − P0. Prints "seconds megapixels name" for each plane, the median of its repetitions.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "reconstruct/bricks/block_pool.hpp"
#include "reconstruct/bricks/brick_source.hpp"
#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/geometry/section_polygon.hpp"
#include "reconstruct/section/sampler.hpp"

namespace {

using namespace biotomy::reconstruct;

constexpr int kSide = 32;

/// The whole volume as bricks.
class BricksInMemory final : public BrickSource {
 public:
  BricksInMemory(const std::string& path, const GridSize& size)
      : cuboid_{size, {1.0, 1.0, 1.0}}, level_(pyramid_level(cuboid_, {})) {
    std::ifstream file(path, std::ios::binary);
    const auto layer_bytes = static_cast<std::size_t>(3 * size.x * size.y);
    std::vector<std::uint8_t> layers(layer_bytes * kSide);
    for (std::int64_t z = 0; z < size.z; z += kSide) {
      const std::int64_t depth = std::min<std::int64_t>(kSide, size.z - z);
      file.read(reinterpret_cast<char*>(layers.data()),
                static_cast<std::streamsize>(layer_bytes) * depth);
      if (!file) {
        throw std::runtime_error(path + ": is shorter than the volume");
      }
      add_bricks(layers, depth);
    }
  }

  const Cuboid& cuboid() const override { return cuboid_; }
  int bits() const override { return 8; }
  std::array<int, 3> brick_shape() const override { return {kSide, kSide, kSide}; }
  int levels() const override { return 1; }
  const PyramidLevel& level(int) const override { return level_; }
  std::int64_t layers_present() const override { return cuboid_.size.z; }
  std::size_t capacity_bytes() const override { return std::size_t{1} << 40; }
  void expect(int, std::span<const ChunkIndex>, const PlaneReach&) override {}

  std::vector<TexelBrick> bricks(int, std::span<const ChunkIndex> wanted,
                                 const PlaneReach&) override {
    std::vector<TexelBrick> result;
    result.reserve(wanted.size());
    for (const ChunkIndex& index : wanted) {
      result.push_back(bricks_[static_cast<std::size_t>(
          (index.z * across(cuboid_.size.y) + index.y) * across(cuboid_.size.x) + index.x)]);
    }
    return result;
  }

 private:
  static std::int64_t across(std::int64_t voxels) { return (voxels + kSide - 1) / kSide; }

  void add_bricks(const std::vector<std::uint8_t>& layers, std::int64_t depth) {
    const GridSize& size = cuboid_.size;
    std::vector<std::byte> voxels(std::size_t{3} * kSide * kSide * kSide);
    for (std::int64_t y = 0; y < size.y; y += kSide) {
      for (std::int64_t x = 0; x < size.x; x += kSide) {
        for (std::int64_t k = 0; k < depth; ++k) {
          for (std::int64_t j = 0; j < std::min<std::int64_t>(kSide, size.y - y); ++j) {
            std::memcpy(voxels.data() + 3 * (k * kSide + j) * kSide,
                        layers.data() + 3 * ((k * size.y + y + j) * size.x + x),
                        static_cast<std::size_t>(3 * std::min<std::int64_t>(kSide, size.x - x)));
          }
        }
        bricks_.push_back(pool_.allocate());
        blocks_.lay_out(voxels, bricks_.back().get());
      }
    }
  }

  Cuboid cuboid_;
  PyramidLevel level_;
  TexelBlocks blocks_{{kSide, kSide, kSide}, 8};
  BlockPool pool_{blocks_.brick_bytes(), TexelBlocks::slack()};
  std::vector<std::shared_ptr<std::byte>> bricks_;
};

struct NamedPlane {
  std::string name;
  std::array<Vector3, 3> points;
};

std::vector<NamedPlane> read_planes(const std::string& path, const std::string& only) {
  std::ifstream file(path);
  std::vector<NamedPlane> planes;
  for (NamedPlane plane; file >> plane.name;) {
    for (Vector3& point : plane.points) {
      file >> point.x >> point.y >> point.z;
    }
    if (only.empty() || only == plane.name) {
      planes.push_back(plane);
    }
  }
  return planes;
}

/// Columns along P1 − P0, as the other programs have them, whatever our own bases would say.
PixelGrid grid_of(const NamedPlane& named, const Cuboid& cuboid) {
  const auto& [a, b, c] = named.points;
  const Plane plane = Plane::through_points(a, b, c);
  const auto unit = [](const Vector3& v) { return (1.0 / norm(v)) * v; };
  const Vector3 u = unit(b - a);
  const Vector3 v = cross(unit(cross(u, c - a)), u);
  const auto rectangle = theta_rectangle(theta::Bounding{}, section_polygon(plane, cuboid), {u, v});
  return pixel_grid(rectangle, 1.0, 3, std::int64_t{1} << 33);
}

/// Walks over memory that has nothing to do with the volume, so that none of that is in a cache.
void evict() {
  static std::vector<std::uint64_t> other(std::size_t{1} << 27);
  tbb::parallel_for(std::size_t{0}, other.size() / 4096, [&](std::size_t page) {
    for (std::size_t i = 0; i < 4096; i += 8) {
      ++other[page * 4096 + i];
    }
  });
}

void write_ppm(const std::string& path, const cv::Mat& image) {
  std::ofstream file(path, std::ios::binary);
  file << "P6\n" << image.cols << ' ' << image.rows << "\n255\n";
  file.write(reinterpret_cast<const char*>(image.data),
             static_cast<std::streamsize>(image.total() * image.elemSize()));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Times sections of a raw volume in memory"};
  std::string volume;
  std::string planes;
  std::string only;
  std::string out;
  std::string kind = "linear";
  GridSize size;
  int repetitions = 5;
  int warm = 1;
  std::size_t threads = 2;
  bool evicting = false;
  app.add_option("VOL", volume)->required();
  app.add_option("NX", size.x)->required();
  app.add_option("NY", size.y)->required();
  app.add_option("NZ", size.z)->required();
  app.add_option("--planes", planes)->required();
  app.add_option("--only", only);
  app.add_option("--reps", repetitions);
  app.add_option("--warm", warm);
  app.add_option("--threads", threads);
  app.add_option("--interpolation", kind);
  app.add_option("--out", out);
  app.add_flag("--evict", evicting);
  CLI11_PARSE(app, argc, argv);
  try {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    BricksInMemory source(volume, size);
    for (const NamedPlane& plane : read_planes(planes, only)) {
      const PixelGrid grid = grid_of(plane, source.cuboid());
      std::vector<double> seconds;
      cv::Mat image;
      for (int run = -warm; run < repetitions; ++run) {
        if (evicting) {
          evict();
        }
        const auto start = std::chrono::steady_clock::now();
        sample_grid(source, grid, interpolation(kind), {0, 0, 0}, image);
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        if (run >= 0) {
          seconds.push_back(taken.count());
        }
      }
      std::sort(seconds.begin(), seconds.end());
      std::printf("%.6f %.4f %s min_s %.6f max_s %.6f\n", seconds[seconds.size() / 2],
                  1e-6 * static_cast<double>(image.total()), plane.name.c_str(), seconds.front(),
                  seconds.back());
      std::fflush(stdout);
      if (!out.empty()) {
        write_ppm(out + plane.name + ".ppm", image);
      }
    }
  } catch (const std::exception& error) {
    std::cerr << "section_peer: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
