#include "reconstruct/bricks/texel_blocks.hpp"

#include <algorithm>
#include <cstring>

namespace biotomy::reconstruct {
namespace {

constexpr int kVectorBytes = 16;
constexpr std::ptrdiff_t kReadBehind = std::ptrdiff_t{2} * kVectorBytes;

int divide_up(int size, int side) {
  return (size + side - 1) / side;
}

/// A row of voxels into the rows of its blocks, by loads and stores of whole vectors: what a store
/// writes too much the next one overwrites, so blocks' rows are filled from the first to the last.
/// Of a known number of bytes per level, so that the compiler knows all steps.
template <int level_bytes>
void lay_row_in_vectors(const std::byte* voxels, int blocks, std::byte* out) {
  constexpr int kRowBytes = (TexelBlocks::kSide + 1) * TexelBlocks::kColours * level_bytes;
  constexpr std::ptrdiff_t kStep =
      std::ptrdiff_t{TexelBlocks::kSide} * TexelBlocks::kColours * level_bytes;
  constexpr std::ptrdiff_t kBlock = std::ptrdiff_t{TexelBlocks::kBlockLevels} * level_bytes;
  for (int block = 0; block < blocks; ++block) {
    for (int part = 0; part < kRowBytes; part += kVectorBytes) {
      std::memcpy(out + part, voxels + part, kVectorBytes);
    }
    voxels += kStep;
    out += kBlock;
  }
}

/// Likewise at the end of the chunk, where no byte too many may be read.
void lay_row_exactly(const std::byte* voxels, int row_of_voxels, int blocks, int step,
                     int block_bytes, int row_bytes, std::byte* out) {
  for (int block = 0; block < blocks; ++block) {
    const int left = row_of_voxels - block * step;
    std::memcpy(out, voxels + std::ptrdiff_t{block} * step,
                static_cast<std::size_t>(std::min(left, row_bytes)));
    out += block_bytes;
  }
}

}  // namespace

TexelBlocks::TexelBlocks(const std::array<int, 3>& shape, int bits)
    : shape_(shape),
      level_bytes_(bits / 8),
      blocks_x_(divide_up(shape[2], kSide)),
      blocks_y_(divide_up(shape[1], kSide)) {}

void TexelBlocks::lay_out(std::span<const std::byte> voxels, std::byte* brick) const {
  const int step = kSide * texel_bytes();
  const int row_of_voxels = shape_[2] * texel_bytes();
  const std::byte* const end = voxels.data() + voxels.size();
  const std::byte* in = voxels.data();
  for (int z = 0; z < shape_[0]; ++z) {
    std::byte* const layer = brick + std::ptrdiff_t{z} * layer_bytes();
    for (int y = 0; y < shape_[1]; ++y) {
      std::byte* const out = layer + along_y(y);
      if (end - in >= std::ptrdiff_t{blocks_x_} * step + kReadBehind) {
        level_bytes_ == 1 ? lay_row_in_vectors<1>(in, blocks_x_, out)
                          : lay_row_in_vectors<2>(in, blocks_x_, out);
      } else {
        lay_row_exactly(in, row_of_voxels, blocks_x_, step, block_bytes(), row_bytes(), out);
      }
      in += row_of_voxels;
    }
  }
}

}  // namespace biotomy::reconstruct
