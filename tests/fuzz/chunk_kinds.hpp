#pragma once

#include <vector>

#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/volume_layout.hpp"

namespace biotomy::tests {

struct ChunkKind {
  reconstruct::VolumeLayout layout;
  int bits = 8;
};

/// Every way to encode a chunk: each codec, interleaved and planar, of 8 and of 16 bits. Chunks are
/// of 4 × 8 × 8 voxels, the fewest that all codecs still squeeze.
inline std::vector<ChunkKind> chunk_kinds() {
  std::vector<ChunkKind> kinds;
  for (const std::string& codec : reconstruct::codec_names()) {
    for (const bool interleaved : {true, false}) {
      for (const int bits : {8, 16}) {
        kinds.push_back({{{4, 8, 8}, {4, 8, 8}, interleaved, codec}, bits});
      }
    }
  }
  return kinds;
}

}  // namespace biotomy::tests
