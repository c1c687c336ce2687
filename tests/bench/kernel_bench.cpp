// The innermost loops by themselves, with Google Benchmark: how fast one thread decodes a chunk
// with each codec, and takes its checksum. Bytes a second are those of the decoded voxels.
//
//   kernel_bench [--benchmark_filter=decode] …

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

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
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
