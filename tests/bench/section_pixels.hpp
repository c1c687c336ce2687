#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/store/pyramid.hpp"
#include "tests/bench/named_planes.hpp"

namespace biotomy::bench {

/// Where the pixel centres of a section's picture lie: the picture that `biotomy section` makes of
/// a plane without further options (basis `layer`, the bounding rectangle), worked out apart from
/// the sampler, so that measurements can hold the one against the other.
struct SectionPixels {
  reconstruct::Cuboid cuboid;   ///< level 0; a pixel outside it is background
  reconstruct::Vector3 origin;  ///< of pixel (0, 0); all in micrometres
  reconstruct::Vector3 right;   ///< from one column to the next
  reconstruct::Vector3 down;    ///< from one row to the next
  std::int64_t columns = 0;
  std::int64_t rows = 0;

  /// In voxels of level 0.
  reconstruct::Vector3 voxel(std::int64_t column, std::int64_t row) const;

  /// False for what is outside the cuboid by more than `border` voxel; a negative border asks for a
  /// distance from it.
  bool inside(const reconstruct::Vector3& voxel, double border) const;
};

/// `pixel` is the distance of two pixels, micrometres. Throws what section_polygon throws.
SectionPixels section_pixels(const NamedPlane& plane, const reconstruct::Cuboid& cuboid,
                             double pixel);

/// A chunk of a level by its place: voxel (x, y, z) of the level lies in chunk x / chunk side, and
/// so on.
struct ChunkPlace {
  std::int64_t z = 0;
  std::int64_t y = 0;
  std::int64_t x = 0;

  friend auto operator<=>(const ChunkPlace&, const ChunkPlace&) = default;
};

/// The chunks of `level` that hold a voxel which some pixel inside the cuboid is interpolated from,
/// found by asking for every pixel; ordered by z, y, x. With reach 1 those are the neighbours that
/// linear interpolation gives a weight, with reach 2 one further on each side. `chunk` is in the
/// order z, y, x.
std::vector<ChunkPlace> touched_chunks(const SectionPixels& pixels,
                                       const reconstruct::PyramidLevel& level,
                                       const std::array<int, 3>& chunk, int reach);

}  // namespace biotomy::bench
