// How fast `biotomy import` is, beside decoding every image and compressing the chunks of level 0,
// on all cores, with nothing stored: once with images decoded by OpenCV, as most programs do it,
// and once as the import decodes them. In MB/s of voxels; they take turns.
//
//   import_bench [FOLDER] [--layers 64] [--side 2000] [--format png|tif] [--noise 3] [--rounds 3]
//                [--output FOLDER]
//
// Without FOLDER, images are made up: smooth structures with a camera's noise.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "reconstruct/import/image_import.hpp"
#include "reconstruct/import/image_sequence.hpp"
#include "reconstruct/store/codecs.hpp"
#include "reconstruct/whole_loop.hpp"
#include "tools/freed_memory.hpp"

namespace {

using namespace biotomy;
using namespace biotomy::reconstruct;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Options {
  std::string folder;
  int layers = 64;
  int side = 2000;
  std::string format = "png";
  double noise = 3.0;
  int rounds = 3;
  std::string output = fs::temp_directory_path() / "biotomy-import-bench";
};

void make_up_images(const fs::path& folder, const Options& options) {
  fs::create_directories(folder);
  whole_loop(static_cast<std::size_t>(options.layers), [&](std::size_t layer) {
    cv::RNG random(layer + 1);
    cv::Mat coarse(options.side / 40 + 2, options.side / 40 + 2, CV_8UC3);
    random.fill(coarse, cv::RNG::UNIFORM, 30, 220);
    cv::Mat image;
    cv::resize(coarse, image, {options.side, options.side}, 0, 0, cv::INTER_CUBIC);
    cv::Mat grain(image.size(), CV_16SC3);
    random.fill(grain, cv::RNG::NORMAL, 0, options.noise);
    cv::add(image, grain, image, cv::noArray(), CV_8U);
    cv::imwrite((folder / (std::to_string(layer + 1) + "." + options.format)).string(), image);
  });
}

/// The image of a layer, from 1.
using Decode = std::function<cv::Mat(std::int64_t layer)>;

/// Decodes all images and compresses all chunks of level 0, as fast as all cores can.
double reference_seconds(const ImageSequence& images, const VolumeLayout& layout,
                         const Decode& decode) {
  const auto start = Clock::now();
  const ChunkCodec codec(layout, images.bits());
  const auto& chunk = layout.chunk;
  for (std::int64_t first = 0; first < images.count(); first += chunk[0]) {
    std::vector<cv::Mat> band(
        static_cast<std::size_t>(std::min<std::int64_t>(chunk[0], images.count() - first)));
    whole_loop(band.size(),
               [&](std::size_t k) { band[k] = decode(first + static_cast<std::int64_t>(k) + 1); });
    const int across = (images.size().width + chunk[2] - 1) / chunk[2];
    const int down = (images.size().height + chunk[1] - 1) / chunk[1];
    whole_loop(static_cast<std::size_t>(across * down), [&](std::size_t place) {
      const cv::Rect face =
          cv::Rect(static_cast<int>(place) % across * chunk[2],
                   static_cast<int>(place) / across * chunk[1], chunk[2], chunk[1]) &
          cv::Rect(cv::Point(0, 0), images.size());
      std::vector<std::byte> voxels(codec.chunk_bytes());
      const std::size_t row_bytes = static_cast<std::size_t>(face.width) * band[0].elemSize();
      const std::size_t stride = static_cast<std::size_t>(chunk[2]) * band[0].elemSize();
      std::byte* out = voxels.data();
      for (const cv::Mat& layer : band) {
        for (int y = 0; y < chunk[1]; ++y, out += stride) {
          if (y < face.height) {
            std::memcpy(out, layer.ptr(face.y + y) + face.x * layer.elemSize(), row_bytes);
          }
        }
      }
      codec.encode(voxels);
    });
  }
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double import_seconds(const ImageSequence& images, const Options& options) {
  ImportRequest request;
  request.output = fs::path(options.output) / "sample";
  request.name = "bench";
  request.scale = VoxelSpacing{{10, 10, 10}};
  fs::remove_all(request.output);
  const auto start = Clock::now();
  import_images(images, request);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  fs::remove_all(request.output);
  return seconds;
}

/// Ratios of one way to decode.
class Ratios {
 public:
  double add(double ratio) {
    ratios_.push_back(ratio);
    return ratio;
  }
  void print(const char* way) {
    std::sort(ratios_.begin(), ratios_.end());
    std::printf("import by %s: median %.2f, from %.2f to %.2f\n", way, ratios_[ratios_.size() / 2],
                ratios_.front(), ratios_.back());
  }

 private:
  std::vector<double> ratios_;
};

void run(const Options& options) {
  tools::keep_freed_memory();  // as the command does
  fs::path folder = options.folder;
  if (folder.empty()) {
    folder = fs::path(options.output) / "images";
    fs::remove_all(folder);
    make_up_images(folder, options);
  }
  const ImageSequence images = ImageSequence::find({folder});
  const double megabytes =
      static_cast<double>(images.count()) * images.size().area() * 3 * (images.bits() / 8) / 1e6;
  std::printf("%lld layers of %d x %d, %d bits: %.0f MB\n%10s %10s %10s %10s %10s\n",
              static_cast<long long>(images.count()), images.size().width, images.size().height,
              images.bits(), megabytes, "OpenCV's", "its own", "import", "ratio", "ratio");
  const Decode as_others = [&](std::int64_t layer) {
    cv::Mat image = cv::imread(images.files()[static_cast<std::size_t>(layer - 1)].string(),
                               cv::IMREAD_ANYDEPTH | cv::IMREAD_COLOR);
    cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
    return image;
  };
  const Decode as_ours = [&](std::int64_t layer) { return images.read(layer); };
  Ratios by_others;
  Ratios by_ours;
  for (int round = 0; round < options.rounds; ++round) {
    const double others = reference_seconds(images, {}, as_others);
    const double ours = reference_seconds(images, {}, as_ours);
    const double import = import_seconds(images, options);
    std::printf("%10.0f %10.0f %10.0f %10.2f %10.2f\n", megabytes / others, megabytes / ours,
                megabytes / import, by_others.add(others / import), by_ours.add(ours / import));
    std::fflush(stdout);
  }
  by_others.print("decoding with OpenCV and compressing");
  by_ours.print("its own decoding and compressing");
  if (options.folder.empty()) {
    fs::remove_all(folder);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures the import beside decoding and compressing alone."};
  Options options;
  app.add_option("FOLDER", options.folder, "Numbered photographs [made-up images]");
  app.add_option("--layers", options.layers, "Made-up images");
  app.add_option("--side", options.side, "Their width and height");
  app.add_option("--format", options.format, "png or tif")->check(CLI::IsMember({"png", "tif"}));
  app.add_option("--noise", options.noise, "Standard deviation of the made-up camera's noise");
  app.add_option("--rounds", options.rounds, "How often each is measured")
      ->check(CLI::Range(1, 1000));
  app.add_option("--output", options.output, "Where to work; a folder on the disk to be measured");
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::cerr << "import_bench: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
