// The innermost loops by themselves, with Google Benchmark: how fast one thread decodes a chunk
// with each codec, takes its checksum and lays it out as a brick, finds a row's bricks, places its
// pixels and mixes them. Bytes a second are those of the decoded voxels, items are pixels.
//
//   kernel_bench [--benchmark_filter=decode] …

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "reconstruct/bricks/row_path.hpp"
#include "reconstruct/bricks/texel_blocks.hpp"
#include "reconstruct/bricks/texel_kernels.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/store/crc32c.hpp"
#include "reconstruct/store/volume_layout.hpp"
#include "tests/bench/made_up_tissue.hpp"

namespace {

using namespace biotomy::reconstruct;
using Bytes = std::vector<std::byte>;

constexpr double kPhotograph = 0.6;   // LZ4 leaves three quarters of it, as of photographs
constexpr std::size_t kChunks = 256;  // 25 MB: more than the cache holds, as in a section

/// Neighbouring chunks along x.
std::vector<Bytes> chunks_of(const VolumeLayout& layout) {
  const biotomy::bench::MadeUpTissue tissue(kPhotograph);
  const auto [depth, height, width] = layout.chunk;
  std::vector<Bytes> chunks(kChunks);
  for (std::size_t i = 0; i < kChunks; ++i) {
    chunks[i].resize(static_cast<std::size_t>(depth) * static_cast<std::size_t>(height) *
                     static_cast<std::size_t>(width) * 3);
    auto* out = reinterpret_cast<std::uint8_t*>(chunks[i].data());
    for (int z = 0; z < depth; ++z) {
      for (int y = 0; y < height; ++y, out += 3 * width) {
        tissue.row(static_cast<std::int64_t>(i) * width, y, z, width, out);
      }
    }
  }
  return chunks;
}

void decode(benchmark::State& state, const VolumeLayout& layout) {
  const ChunkCodec codec(layout, 8);
  std::vector<Bytes> encoded;
  for (const Bytes& chunk : chunks_of(layout)) {
    encoded.push_back(codec.encode(chunk));
  }
  Bytes voxels(codec.chunk_bytes());
  std::size_t next = 0;
  for (auto _ : state) {
    codec.decode(encoded[next++ % encoded.size()], voxels);
    benchmark::DoNotOptimize(voxels.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(voxels.size()));
}

void checksum(benchmark::State& state, std::uint32_t (*crc)(std::span<const std::byte>)) {
  const std::vector<Bytes> chunks = chunks_of(VolumeLayout{});
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(crc(chunks[next++ % chunks.size()]));
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(chunks[0].size()));
}

void lay_out(benchmark::State& state) {
  const VolumeLayout layout;
  const std::vector<Bytes> chunks = chunks_of(layout);
  const TexelBlocks blocks(layout.chunk, 8);
  Bytes brick(blocks.brick_bytes() + TexelBlocks::slack());
  std::size_t next = 0;
  for (auto _ : state) {
    blocks.lay_out(chunks[next++ % chunks.size()], brick.data());
    benchmark::DoNotOptimize(brick.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(chunks[0].size()));
}

/// A row of pixels of the size of a voxel, at 45° through a box of bricks that stay in the cache.
class Row {
 public:
  Row() {
    path_.block_row_bytes = blocks_.block_row_bytes();
    path_.layer_bytes = blocks_.layer_bytes();
    constexpr std::int32_t kVoxel = 1 << kFractionBits;
    const auto step = static_cast<std::int32_t>(std::sqrt(0.5) * kVoxel);
    int slot_stride = 1;
    int base = 0;
    for (RowAxis& axis : path_.axes) {
      axis = {kVoxel / 3, step, base, kBricks * kSide - 1, 0, kSide, slot_stride, 1};
      slot_stride *= kBricks;
      base += 11;  // so that the row goes from brick to brick along one axis at a time
    }
    path_.axes[2].step = 0;  // rows lie in a layer
    bricks_.assign(static_cast<std::size_t>(slot_stride), memory_.data());
    places_.resize(kPixels);
    place();
  }

  void find() { find_bricks(path_, kPixels, found_.data()); }
  void place() { place_row(path_, kPixels, bricks_.data(), places_); }
  void mix() { mix_linear(places_, kPixels, {}, pixels_.data()); }

  static constexpr int kPixels = kMostPixels;

 private:
  static constexpr int kSide = 32;
  static constexpr int kBricks = 8;

  TexelBlocks blocks_{{kSide, kSide, kSide}, 8};
  Bytes memory_ = Bytes(blocks_.brick_bytes() + TexelBlocks::slack());
  std::vector<const std::byte*> bricks_;
  RowPath path_;
  std::vector<std::int32_t> found_ = std::vector<std::int32_t>(kFoundRoom);
  PixelPlaces<std::uint8_t> places_;
  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(3 * kPixels);
};

void row_step(benchmark::State& state, void (Row::*step)()) {
  Row row;
  for (auto _ : state) {
    (row.*step)();
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * Row::kPixels);
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::string& name : codec_names()) {
    for (const bool interleaved : {true, false}) {
      VolumeLayout layout;
      layout.codec = name;
      layout.interleaved = interleaved;
      const std::string title = "decode/" + name + (interleaved ? "/interleaved" : "/planar");
      benchmark::RegisterBenchmark(title.c_str(), decode, layout);
    }
  }
  benchmark::RegisterBenchmark("crc32c", checksum, crc32c);
  benchmark::RegisterBenchmark("lay_out", lay_out);
  benchmark::RegisterBenchmark("row/find_bricks", row_step, &Row::find);
  benchmark::RegisterBenchmark("row/place_row", row_step, &Row::place);
  benchmark::RegisterBenchmark("row/mix_linear", row_step, &Row::mix);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
