#pragma once

#include <array>
#include <cstdint>

namespace biotomy::bench {

/// The colours R, G, B of a made-up sample, a formula of the voxel's place: cells of one colour
/// each, 24 voxels along each side, and at a share of the voxels a camera's noise of up to some
/// levels. Whoever has a picture of it can check any pixel, and a store of any size need hold only
/// what is looked at.
class MadeUpTissue {
 public:
  /// `noisy` is the share of voxels with noise, 0 to 1. At 1 there is nothing for a codec to find,
  /// as in photographs; at less the store is smaller.
  explicit MadeUpTissue(double noisy);

  std::array<std::uint8_t, 3> voxel(std::int64_t x, std::int64_t y, std::int64_t z) const;

  /// The voxels (x to x + count − 1, y, z), colours side by side.
  void row(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t count,
           std::uint8_t* out) const;

 private:
  std::uint32_t noisy_of_65536_;
};

}  // namespace biotomy::bench
