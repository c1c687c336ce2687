#pragma once

#include <array>
#include <string>

namespace biotomy::reconstruct {

/// How a volume is cut up and encoded on disk. Sizes are in voxels in the order z, y, x; the three
/// colours are never split. The defaults are chosen by measurement (docs/decisions.md).
struct VolumeLayout {
  std::array<int, 3> chunk{32, 32, 32};
  std::array<int, 3> shard{32, 1024, 1024};  ///< each a multiple of the chunk's
  bool interleaved =
      true;  ///< colours stored voxel by voxel (codec `transpose`), not plane by plane
  std::string codec = "blosc-lz4-noshuffle";  ///< a name that `codec_chain` knows

  friend bool operator==(const VolumeLayout&, const VolumeLayout&) = default;
};

/// Blosc compresses a chunk whose colours are interleaved in four blocks of whole layers, each by
/// itself, so that who needs some layers need not decode them all. So many layers has each but the
/// last, of a chunk of `layers`.
constexpr int layers_of_a_block(int layers) {
  constexpr int kBlocks = 4;
  return (layers + kBlocks - 1) / kBlocks;
}

/// Throws InvalidRequest when chunk and shard do not fit each other or the codec is not known.
void check_layout(const VolumeLayout& layout);

}  // namespace biotomy::reconstruct
