#include "tests/bench/section_pixels.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>

#include <oneapi/tbb/parallel_for.h>

#include "reconstruct/geometry/plane.hpp"
#include "reconstruct/geometry/section_basis.hpp"
#include "reconstruct/geometry/section_polygon.hpp"

namespace biotomy::bench {
namespace {

using namespace biotomy::reconstruct;

constexpr double kWholePixel = 1e-6;   // of a pixel: a width of 99.9999999 pixels holds 100
constexpr double kBorder = 1e-6;       // of a voxel, as the sampler takes it
constexpr double kOnTheCentre = 1e-9;  // of a voxel: the neighbour's weight is zero

Vector3 in_micrometres(const Vector3& voxel, const Vector3& spacing) {
  return {voxel.x * spacing.x, voxel.y * spacing.y, voxel.z * spacing.z};
}

std::int64_t divide_up(std::int64_t size, std::int64_t block) {
  return (size + block - 1) / block;
}

/// First and last voxel along one axis that a coordinate is interpolated from.
struct Support {
  std::int64_t first;
  std::int64_t last;
};
Support support(double coordinate, std::int64_t size, int reach) {
  const double within = std::clamp(coordinate, 0.0, static_cast<double>(size - 1));
  const double below = std::floor(within + kOnTheCentre);
  const bool centre = std::abs(within - below) <= kOnTheCentre;
  const auto first = static_cast<std::int64_t>(below) - (reach - 1);
  const auto last = static_cast<std::int64_t>(below) + (centre && reach == 1 ? 0 : reach);
  return {std::max<std::int64_t>(first, 0), std::min(last, size - 1)};
}

}  // namespace

Vector3 SectionPixels::voxel(std::int64_t column, std::int64_t row) const {
  const Vector3 centre =
      origin + static_cast<double>(column) * right + static_cast<double>(row) * down;
  return {centre.x / cuboid.spacing.x, centre.y / cuboid.spacing.y, centre.z / cuboid.spacing.z};
}

bool SectionPixels::inside(const Vector3& voxel, double border) const {
  const auto within = [border](double coordinate, std::int64_t size) {
    return coordinate >= -border && coordinate <= static_cast<double>(size - 1) + border;
  };
  return within(voxel.x, cuboid.size.x) && within(voxel.y, cuboid.size.y) &&
         within(voxel.z, cuboid.size.z);
}

SectionPixels section_pixels(const NamedPlane& named, const Cuboid& cuboid, double pixel) {
  const Plane plane = Plane::through_points(in_micrometres(named.points[0], cuboid.spacing),
                                            in_micrometres(named.points[1], cuboid.spacing),
                                            in_micrometres(named.points[2], cuboid.spacing));
  const SectionBasis basis = section_basis(BasisKind::layer, plane);
  const std::vector<Vector3> polygon = section_polygon(plane, cuboid);
  // Measured from a vertex: a section along a layer then starts exactly at the sample's corner.
  const Vector3& corner = polygon.front();
  double left = 0.0;
  double right = 0.0;
  double top = 0.0;
  double bottom = 0.0;
  for (const Vector3& vertex : polygon) {
    const double along_p = dot(vertex - corner, basis.p);
    const double along_q = dot(vertex - corner, basis.q);
    left = std::min(left, along_p);
    right = std::max(right, along_p);
    top = std::min(top, along_q);
    bottom = std::max(bottom, along_q);
  }
  const auto count = [pixel](double length) {
    return static_cast<std::int64_t>(std::floor(length / pixel + kWholePixel)) + 1;
  };
  return {cuboid,
          corner + left * basis.p + top * basis.q,
          pixel * basis.p,
          pixel * basis.q,
          count(right - left),
          count(bottom - top)};
}

std::vector<ChunkPlace> touched_chunks(const SectionPixels& pixels, const PyramidLevel& level,
                                       const std::array<int, 3>& chunk, int reach) {
  const std::int64_t along_z = divide_up(level.size.z, chunk[0]);
  const std::int64_t along_y = divide_up(level.size.y, chunk[1]);
  const std::int64_t along_x = divide_up(level.size.x, chunk[2]);
  std::vector<unsigned char> touched(static_cast<std::size_t>(along_z * along_y * along_x));

  tbb::parallel_for(std::int64_t{0}, pixels.rows, [&](std::int64_t row) {
    for (std::int64_t column = 0; column < pixels.columns; ++column) {
      const Vector3 voxel = pixels.voxel(column, row);
      if (!pixels.inside(voxel, kBorder)) {
        continue;
      }
      const Vector3 place = in_micrometres(voxel, pixels.cuboid.spacing) - level.origin;
      const Support z = support(place.z / level.spacing.z, level.size.z, reach);
      const Support y = support(place.y / level.spacing.y, level.size.y, reach);
      const Support x = support(place.x / level.spacing.x, level.size.x, reach);
      for (std::int64_t cz = z.first / chunk[0]; cz <= z.last / chunk[0]; ++cz) {
        for (std::int64_t cy = y.first / chunk[1]; cy <= y.last / chunk[1]; ++cy) {
          for (std::int64_t cx = x.first / chunk[2]; cx <= x.last / chunk[2]; ++cx) {
            const std::int64_t number = (cz * along_y + cy) * along_x + cx;
            std::atomic_ref(touched[static_cast<std::size_t>(number)])
                .store(1, std::memory_order_relaxed);
          }
        }
      }
    }
  });

  std::vector<ChunkPlace> places;
  for (std::int64_t number = 0; number < along_z * along_y * along_x; ++number) {
    if (touched[static_cast<std::size_t>(number)] != 0) {
      places.push_back(
          {number / (along_y * along_x), number / along_x % along_y, number % along_x});
    }
  }
  return places;
}

}  // namespace biotomy::bench
