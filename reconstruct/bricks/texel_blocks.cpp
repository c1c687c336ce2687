#include "reconstruct/bricks/texel_blocks.hpp"

#include <algorithm>
#include <cstring>

namespace biotomy::reconstruct {
namespace {

constexpr int kVectorBytes = 16;
constexpr int kReadBehind = 2 * kVectorBytes;

int divide_up(int size, int side) {
  return (size + side - 1) / side;
}

/// A row of voxels into the rows of its blocks, by loads and stores of whole vectors: what a store
/// writes too much the next one overwrites, so blocks' rows are filled from the first to the last.
template <int row_bytes, std::ptrdiff_t step, std::ptrdiff_t block_bytes>
void lay_row_in_vectors(const std::byte* voxels, int blocks, std::byte* out) {
  for (int block = 0; block < blocks; ++block) {
    for (int part = 0; part < row_bytes; part += kVectorBytes) {
      std::memcpy(out + part, voxels + part, kVectorBytes);
    }
    voxels += step;
    out += block_bytes;
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
  lay_out(voxels, {{}, {shape_[2], shape_[1], shape_[0]}}, brick);
}

void TexelBlocks::lay_out(std::span<const std::byte> voxels, const Box& box,
                          std::byte* brick) const {
  level_bytes_ == 1 ? lay_out_levels<1>(voxels, box, brick) : lay_out_levels<2>(voxels, box, brick);
}

// Of a known number of bytes per level, so that the compiler knows all steps.
template <int level_bytes>
void TexelBlocks::lay_out_levels(std::span<const std::byte> voxels, const Box& box,
                                 std::byte* brick) const {
  constexpr int kRowBytes = (kSide + 1) * kColours * level_bytes;
  constexpr int kStep = kSide * kColours * level_bytes;
  constexpr int kBlock = kBlockLevels * level_bytes;
  const int blocks = divide_up(box.end[0], kSide) - box.first[0] / kSide;
  const int rest_of_row = (shape_[2] - box.first[0]) * kColours * level_bytes;
  const std::ptrdiff_t row_of_voxels = std::ptrdiff_t{shape_[2]} * kColours * level_bytes;
  const std::byte* const last_in_vectors =
      voxels.data() + voxels.size() -
      std::min(voxels.size(), static_cast<std::size_t>(blocks * kStep + kReadBehind));
  for (int z = box.first[2]; z < box.end[2]; ++z) {
    std::byte* const layer = brick + std::ptrdiff_t{z} * layer_bytes() + along_x(box.first[0]);
    const std::byte* in = voxels.data() + std::ptrdiff_t{box.first[0]} * kColours * level_bytes +
                          (std::ptrdiff_t{z} * shape_[1] + box.first[1]) * row_of_voxels;
    for (int y = box.first[1]; y < box.end[1]; ++y, in += row_of_voxels) {
      std::byte* const out = layer + along_y(y);
      if (in < last_in_vectors) {
        lay_row_in_vectors<kRowBytes, kStep, kBlock>(in, blocks, out);
      } else {
        lay_row_exactly(in, rest_of_row, blocks, kStep, kBlock, kRowBytes, out);
      }
    }
  }
}

}  // namespace biotomy::reconstruct
