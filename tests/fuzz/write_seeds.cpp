// Writes the seeds of the fuzz targets by the project's own writers.
// usage: write_fuzz_seeds FOLDER      (in the repository: tests/fuzz/corpus)

#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "reconstruct/sample/layer_image.hpp"
#include "reconstruct/sample/sample_folder.hpp"
#include "reconstruct/store/ome_metadata.hpp"
#include "reconstruct/store/shard.hpp"
#include "reconstruct/store/zarr_array.hpp"
#include "tests/fuzz/chunk_kinds.hpp"
#include "tests/reconstruct/whole_shard.hpp"
#include "tests/temporary_folder.hpp"

namespace biotomy::tests {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChecksumBytes = 4;

std::span<const std::byte> without_checksum(const std::vector<std::byte>& bytes) {
  return std::span(bytes).first(bytes.size() - kChecksumBytes);
}

class Seeds {
 public:
  explicit Seeds(fs::path folder) : folder_(std::move(folder)) {}

  void write(const std::string& target, const std::string& name,
             std::span<const std::byte> bytes) const {
    fs::create_directories(folder_ / target);
    std::ofstream(folder_ / target / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  void write(const std::string& target, const std::string& name, const std::string& text) const {
    write(target, name, std::as_bytes(std::span(text)));
  }
  void copy(const std::string& target, const std::string& name, const fs::path& file) const {
    fs::create_directories(folder_ / target);
    fs::copy_file(file, folder_ / target / name, fs::copy_options::overwrite_existing);
  }

 private:
  fs::path folder_;
};

void write_metadata(const Seeds& seeds) {
  seeds.write("group_metadata", "one-level",
              reconstruct::group_metadata({"knee", {10, 10, 20}, 8, {{}}, 0}));
  seeds.write("group_metadata", "three-levels",
              reconstruct::group_metadata(
                  {"knee", {10.5, 11, 50}, 16, {{1, 1, 1}, {2, 2, 1}, {4, 4, 2}}, 96, true}));
  for (const ChunkKind& kind : chunk_kinds()) {
    seeds.write("array_metadata",
                kind.layout.codec + (kind.layout.interleaved ? "-interleaved-" : "-planar-") +
                    std::to_string(kind.bits),
                reconstruct::array_metadata({{500, 300, 100}, kind.bits, kind.layout}));
  }
}

void write_indices(const Seeds& seeds) {
  const std::vector<std::byte> chunk(40, std::byte{7});
  const auto index = [](const std::vector<std::vector<std::byte>>& chunks) {
    const std::vector<std::byte> shard = reconstruct::whole_shard(chunks);
    const auto last = std::span(shard).last(reconstruct::shard_index_bytes(chunks.size()));
    return std::vector<std::byte>(last.begin(), last.end());
  };
  seeds.write("shard_index", "one-chunk", without_checksum(index({chunk})));
  seeds.write("shard_index", "with-gaps", without_checksum(index({chunk, {}, {}, chunk, chunk})));
}

void write_chunks(const Seeds& seeds) {
  const std::vector<ChunkKind> kinds = chunk_kinds();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const reconstruct::ChunkCodec codec(kinds[i].layout, kinds[i].bits);
    std::vector<std::byte> voxels(codec.chunk_bytes());
    for (std::size_t byte = 0; byte < voxels.size(); ++byte) {
      voxels[byte] = static_cast<std::byte>(byte / 48 * 3);
    }
    std::vector<std::byte> seed = codec.encode(voxels);
    seed.resize(seed.size() - kChecksumBytes);
    seed.insert(seed.begin(), static_cast<std::byte>(i));
    seeds.write("chunk_decode",
                kinds[i].layout.codec +
                    (kinds[i].layout.interleaved ? "-interleaved-" : "-planar-") +
                    std::to_string(kinds[i].bits),
                seed);
  }
}

void write_sample_files(const Seeds& seeds) {
  const TemporaryFolder folder;
  reconstruct::SampleFolder::create(
      folder / "sample", {"knee \"042\"", {{50, 40, 9}, {10.5, 11, 20}}, 16, "left", "2026-01-02"});
  seeds.copy("sample_description", "whole", folder / "sample" / "sample.toml");
  for (const int type : {CV_8UC3, CV_16UC3}) {
    for (const auto compression :
         {reconstruct::LayerCompression::zstd, reconstruct::LayerCompression::deflate}) {
      const auto file = folder / "layer.tif";
      const cv::Mat image(20, 30, type, cv::Scalar(10, 20, 30));
      reconstruct::write_layer_image(file, image, {1, {10, 10, 20}}, {compression, 1});
      seeds.copy(
          "layer_image",
          std::string(compression == reconstruct::LayerCompression::zstd ? "zstd" : "deflate") +
              (type == CV_8UC3 ? "-8" : "-16"),
          file);
    }
  }
}

void write_parameters(const Seeds& seeds) {
  seeds.write("parameter_text", "points", "0,0,0 1e3,+5,0.25 -7,8,9");
  seeds.write("parameter_text", "normal-and-point", "0,0,1 10,10,5000");
  seeds.write("parameter_text", "number", "12.5");
  seeds.write("parameter_text", "colour", "255, 0,17");
  seeds.write("parameter_text", "unit", "voxel");
}

}  // namespace
}  // namespace biotomy::tests

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "write_fuzz_seeds: give the folder to write to\n";
    return 2;
  }
  const biotomy::tests::Seeds seeds(argv[1]);
  biotomy::tests::write_metadata(seeds);
  biotomy::tests::write_indices(seeds);
  biotomy::tests::write_chunks(seeds);
  biotomy::tests::write_sample_files(seeds);
  biotomy::tests::write_parameters(seeds);
  return 0;
}
