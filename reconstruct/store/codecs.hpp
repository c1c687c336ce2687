#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "reconstruct/store/volume_layout.hpp"

namespace biotomy::reconstruct {

struct Compressor;

/// The names that a VolumeLayout's `codec` can have: `raw`, `zstd1`, `blosc-lz4-bitshuffle` and
/// their like. Blosc shuffles single colour values: with whole voxels for elements (typesize 3) it
/// was slower and no smaller.
std::vector<std::string> codec_names();

/// Throws InvalidRequest, naming those that there are.
void check_codec_name(const std::string& name);

/// The codecs of an inner chunk as Zarr v3 writes them: `transpose` (when interleaved), `bytes`,
/// the compressor, `crc32c`. `transpose` has the order [1, 2, 3, 0]: dimension i of what is encoded
/// is dimension order[i] of the array c, z, y, x (Zarr v3, codec "transpose" 1.0), so that a
/// voxel's colours lie side by side.
nlohmann::json codec_chain(const VolumeLayout& layout, int bits);

/// Layers of a chunk, from `first` to before `end`, counted within it.
struct ChunkLayers {
  int first = 0;
  int end = 0;
};

/// Encodes and decodes inner chunks. Safe for many threads.
class ChunkCodec {
 public:
  ChunkCodec(const VolumeLayout& layout, int bits);

  /// Bytes of one decoded chunk.
  std::size_t chunk_bytes() const { return voxels_ * kColours * value_bytes_; }

  /// More bytes than any encoder makes of a chunk: none stores what it cannot squeeze at twice its
  /// size. Who allocates what a file asks for allocates no more than this.
  std::size_t longest_encoded() const { return 2 * chunk_bytes() + kLeastEncoded; }

  /// `voxels` is laid out as ChunkVoxels says, whatever the layout on disk.
  std::vector<std::byte> encode(std::span<const std::byte> voxels) const;

  /// Fills `voxels`, which has chunk_bytes(). Throws SampleError, with neither file nor place in
  /// its message, when `encoded` is damaged.
  void decode(std::span<const std::byte> encoded, std::span<std::byte> voxels) const;

  /// Likewise, where only some layers are needed: the voxels of others may mean nothing. The chunk
  /// lies in `room`, which has chunk_bytes(), or in `encoded`, if that holds it uncompressed.
  std::span<const std::byte> decode_layers(std::span<const std::byte> encoded, ChunkLayers layers,
                                           std::span<std::byte> room) const;

  /// Whether that may be less work than decoding all.
  bool decodes_by_layers() const;

 private:
  static constexpr std::size_t kColours = 3;
  static constexpr std::size_t kLeastEncoded = 1024;  // headers and checksums of tiny chunks

  void decode_body(std::span<const std::byte> body, std::span<std::byte> voxels) const;
  bool decompress_layers(std::span<const std::byte> body, std::size_t value_bytes,
                         ChunkLayers layers, std::span<std::byte> room) const;
  std::vector<std::byte> compress(std::span<const std::byte> plain) const;
  void decompress(std::span<const std::byte> encoded, std::span<std::byte> plain) const;

  const Compressor& compressor_;
  bool interleaved_;
  std::size_t layers_;
  std::size_t voxels_;
  std::size_t value_bytes_;
  std::size_t block_bytes_;
};

}  // namespace biotomy::reconstruct
