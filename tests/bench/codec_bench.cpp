// How well and how fast each codec of the volume store does, for a stack of photographs or for
// made-up tissue with a camera's noise: ratio, and speed of one thread in MB/s of voxels.
//
//   codec_bench [FOLDER] [--chunk 32,32,32] [--noise 2.0] [--seconds 0.5]

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "reconstruct/import/image_sequence.hpp"
#include "reconstruct/store/codecs.hpp"

namespace {

using namespace biotomy::reconstruct;
using Bytes = std::vector<std::byte>;
using Clock = std::chrono::steady_clock;

struct Options {
  std::string folder;
  std::vector<int> chunk{32, 32, 32};
  double noise = 2.0;
  double seconds = 0.5;
};

constexpr int kMadeUpLayers = 64;
constexpr int kMadeUpSide = 256;

/// Structures of several sizes that go on from layer to layer, coloured like tissue, and noise.
std::vector<cv::Mat> made_up_tissue(double noise) {
  cv::RNG random(42);
  std::vector<cv::Mat> layers(kMadeUpLayers, cv::Mat());
  for (cv::Mat& layer : layers) {
    layer = cv::Mat(kMadeUpSide, kMadeUpSide, CV_32FC1, cv::Scalar(0));
  }
  for (const int grain : {8, 24, 64}) {
    const int nodes = kMadeUpSide / grain + 2;
    std::vector<cv::Mat> field;  // a coarse random field, smoothly enlarged in x and y, then in z
    for (int z = 0; z <= kMadeUpLayers / grain + 1; ++z) {
      cv::Mat coarse(nodes, nodes, CV_32FC1);
      random.fill(coarse, cv::RNG::NORMAL, 0, 1);
      cv::Mat fine;
      cv::resize(coarse, fine, {kMadeUpSide, kMadeUpSide}, 0, 0, cv::INTER_CUBIC);
      field.push_back(fine);
    }
    for (int z = 0; z < kMadeUpLayers; ++z) {
      const auto below = static_cast<std::size_t>(z / grain);
      const double part = static_cast<double>(z % grain) / grain;
      layers[static_cast<std::size_t>(z)] += field[below] * (1 - part) + field[below + 1] * part;
    }
  }
  for (cv::Mat& layer : layers) {
    std::vector<cv::Mat> colours;
    for (const auto& [level, contrast] : {std::pair{170, 25}, {105, 30}, {95, 28}}) {
      cv::Mat colour = layer * contrast + level;
      cv::Mat grain(colour.size(), CV_32FC1);
      random.fill(grain, cv::RNG::NORMAL, 0, noise);
      cv::Mat eight_bits;
      cv::Mat(colour + grain).convertTo(eight_bits, CV_8U);
      colours.push_back(eight_bits);
    }
    cv::merge(colours, layer);
  }
  return layers;
}

std::vector<cv::Mat> photographs(const std::string& folder) {
  const ImageSequence sequence = ImageSequence::find({folder});
  std::vector<cv::Mat> layers;
  for (std::int64_t layer = 1; layer <= sequence.count(); ++layer) {
    layers.push_back(sequence.read(layer));
  }
  return layers;
}

/// Whole chunks only.
std::vector<Bytes> chunks_of(const std::vector<cv::Mat>& layers, const std::vector<int>& chunk) {
  std::vector<Bytes> chunks;
  const auto depth = static_cast<std::size_t>(chunk[2]);
  for (std::size_t z = 0; z + depth <= layers.size(); z += depth) {
    for (int y = 0; y + chunk[1] <= layers[0].rows; y += chunk[1]) {
      for (int x = 0; x + chunk[0] <= layers[0].cols; x += chunk[0]) {
        Bytes voxels;
        for (std::size_t dz = 0; dz < depth; ++dz) {
          const cv::Mat part = layers[z + dz](cv::Rect(x, y, chunk[0], chunk[1])).clone();
          const auto* data = reinterpret_cast<const std::byte*>(part.data);
          voxels.insert(voxels.end(), data, data + part.total() * part.elemSize());
        }
        chunks.push_back(std::move(voxels));
      }
    }
  }
  return chunks;
}

/// MB/s of one thread, over at least `seconds`.
double speed(double megabytes, double seconds, const std::function<void()>& pass) {
  int passes = 0;
  const auto start = Clock::now();
  double elapsed = 0;
  do {
    pass();
    ++passes;
    elapsed = std::chrono::duration<double>(Clock::now() - start).count();
  } while (elapsed < seconds);
  return megabytes * passes / elapsed;
}

void measure(const std::vector<Bytes>& chunks, const VolumeLayout& layout, int bits,
             double seconds) {
  const ChunkCodec codec(layout, bits);
  const double megabytes =
      static_cast<double>(chunks.size()) * static_cast<double>(codec.chunk_bytes()) / 1e6;
  std::vector<Bytes> encoded(chunks.size());
  const double encode = speed(megabytes, seconds, [&] {
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      encoded[i] = codec.encode(chunks[i]);
    }
  });
  double stored = 0;
  for (const Bytes& each : encoded) {
    stored += static_cast<double>(each.size()) / 1e6;
  }
  Bytes decoded(codec.chunk_bytes());
  const double decode = speed(megabytes, seconds, [&] {
    for (const Bytes& each : encoded) {
      codec.decode(each, decoded);
    }
  });
  std::printf("%-28s %-12s %6.3f %8.0f %8.0f\n", layout.codec.c_str(),
              layout.interleaved ? "interleaved" : "planar", megabytes / stored, encode, decode);
  std::fflush(stdout);
}

void run(const Options& options) {
  const std::vector<cv::Mat> layers =
      options.folder.empty() ? made_up_tissue(options.noise) : photographs(options.folder);
  const std::vector<Bytes> chunks = chunks_of(layers, options.chunk);
  if (chunks.empty()) {
    throw std::runtime_error("the stack is smaller than one chunk");
  }
  std::printf("%zu chunks of %d,%d,%d\n%-28s %-12s %6s %8s %8s\n", chunks.size(), options.chunk[0],
              options.chunk[1], options.chunk[2], "codec", "colours", "ratio", "encode", "decode");
  for (const std::string& name : codec_names()) {
    for (const bool interleaved : {true, false}) {
      VolumeLayout layout;
      layout.chunk = {options.chunk[2], options.chunk[1], options.chunk[0]};
      layout.shard = layout.chunk;
      layout.codec = name;
      layout.interleaved = interleaved;
      measure(chunks, layout, layers[0].depth() == CV_8U ? 8 : 16, options.seconds);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures the codecs of the volume store."};
  Options options;
  app.add_option("FOLDER", options.folder, "Numbered photographs [made-up tissue]");
  app.add_option("--chunk", options.chunk, "X,Y,Z")->delimiter(',')->expected(3);
  app.add_option("--noise", options.noise, "Standard deviation of the made-up camera's noise");
  app.add_option("--seconds", options.seconds, "For each figure");
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::cerr << "codec_bench: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
