#include "reconstruct/store/layer_band.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>

#include <opencv2/core.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/whole_loop.hpp"

namespace biotomy::reconstruct {
namespace {

/// Beyond these a file is opened for each region: a program may have no more than 1024 open.
constexpr std::size_t kKeptOpen = 256;

}  // namespace

LayerBand::LayerBand(const SampleFolder& sample, std::int64_t first, std::int64_t count) {
  const SampleDescription& description = sample.description();
  const GridSize& size = description.cuboid.size;
  const int type = description.bits == 8 ? CV_8UC3 : CV_16UC3;
  for (std::int64_t layer = first; layer < first + count; ++layer) {
    const std::filesystem::path path = sample.layer_path(layer);
    auto reader = std::make_unique<LayerImageReader>(path);
    if (reader->width() != size.x || reader->height() != size.y || reader->type() != type) {
      throw SampleError(path.string() + ": is " + std::to_string(reader->width()) + " × " +
                        std::to_string(reader->height()) + " of " +
                        (reader->type() == CV_8UC3 ? "8" : "16") + " bits, the sample is " +
                        std::to_string(size.x) + " × " + std::to_string(size.y) + " of " +
                        std::to_string(description.bits));
    }
    paths_.push_back(path);
    if (readers_.size() < kKeptOpen) {
      readers_.push_back(std::move(reader));
    }
  }
}

std::vector<cv::Mat> LayerBand::read(const cv::Rect& region) const {
  std::vector<cv::Mat> layers(paths_.size());
  whole_loop(paths_.size(), [&](std::size_t i) {
    layers[i] =
        i < readers_.size() ? readers_[i]->read(region) : LayerImageReader(paths_[i]).read(region);
  });
  return layers;
}

}  // namespace biotomy::reconstruct
