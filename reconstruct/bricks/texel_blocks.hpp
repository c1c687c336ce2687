#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace biotomy::reconstruct {

/// How a decoded chunk lies in memory for the sampler: a brick. An oblique plane leaves a line of
/// voxels soon, whichever way the line runs, so the texels that one line of the processor's cache
/// holds are a block of 4 × 4 in a layer, whole even where the chunk's sides are no multiples of 4.
/// Each of a block's four rows has the first texel of the next block as a fifth, so that a texel
/// and its neighbour along x are always one load. With 8 bits that makes 4 × 5 × 3 = 60 of 64
/// bytes, with 16 bits 120 of 128. The fifth texel of a row's last block belongs to another brick:
/// it means nothing.
///
/// A texel's place is the sum of what its three coordinates contribute.
class TexelBlocks {
 public:
  static constexpr int kSide = 4;
  static constexpr int kColours = 3;
  static constexpr int kBlockLevels = 64;  ///< room for a block's

  /// `shape` is of the chunk: z, y, x.
  TexelBlocks(const std::array<int, 3>& shape, int bits);

  int level_bytes() const { return level_bytes_; }
  int texel_bytes() const { return kColours * level_bytes_; }
  int row_bytes() const { return (kSide + 1) * texel_bytes(); }  ///< of a block's row
  int block_bytes() const { return kBlockLevels * level_bytes_; }
  int block_row_bytes() const { return blocks_x_ * block_bytes(); }  ///< from a block to that below
  /// With a block to spare: were it a power of two, the texels above each other would share a set
  /// of the processor's cache.
  int layer_bytes() const { return blocks_y_ * block_row_bytes() + block_bytes(); }
  std::size_t brick_bytes() const {
    return static_cast<std::size_t>(shape_[0]) * static_cast<std::size_t>(layer_bytes());
  }

  // Texels are counted from 0: said without a sign it is a shift and a mask.
  int along_x(int texel) const {
    const auto number = static_cast<unsigned>(texel);
    return static_cast<int>(number / kSide) * block_bytes() +
           static_cast<int>(number % kSide) * texel_bytes();
  }
  int along_y(int texel) const {
    const auto number = static_cast<unsigned>(texel);
    return static_cast<int>(number / kSide) * block_row_bytes() +
           static_cast<int>(number % kSide) * row_bytes();
  }
  int along_z(int texel) const { return texel * layer_bytes(); }

  /// What along_x, along_y and along_z say, for axis 0, 1 and 2.
  int along(std::size_t axis, int texel) const {
    return axis == 0 ? along_x(texel) : axis == 1 ? along_y(texel) : along_z(texel);
  }

  /// Lays the voxels of a chunk (as ChunkVoxels has them) out as a brick.
  void lay_out(std::span<const std::byte> voxels, std::byte* brick) const;

  /// Voxels of a chunk, along each axis from `first` to before `end`.
  struct Box {
    std::array<int, 3> first{};  ///< x, y, z; along x and y multiples of kSide
    std::array<int, 3> end{};    ///< likewise, or the chunk's
  };

  /// Only those in `box`, and only these blocks are written.
  void lay_out(std::span<const std::byte> voxels, const Box& box, std::byte* brick) const;

  /// How many bytes after a brick's end may be read: a vector's.
  static constexpr std::size_t slack() { return 64; }

 private:
  template <int level_bytes>
  void lay_out_levels(std::span<const std::byte> voxels, const Box& box, std::byte* brick) const;

  std::array<int, 3> shape_;
  int level_bytes_;
  int blocks_x_;
  int blocks_y_;
};

}  // namespace biotomy::reconstruct
