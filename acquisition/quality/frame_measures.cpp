#include "acquisition/quality/frame_measures.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <opencv2/core/utility.hpp>

namespace biotomy::acquisition {
namespace {

constexpr int kReach = DetailMeasurer::kReach;
constexpr int kMostMiddle = 112;

struct Colours {
  std::array<double, 3> sums{};  ///< of full scale
  double counted = 0.0;
  double clipped = 0.0;

  double mean(std::size_t colour) const { return counted > 0.0 ? sums[colour] / counted : 0.0; }
};

template <typename Sample>
void add_colours(const Sample* pixels, const float* brightness, int width, Colours& colours) {
  std::array<std::uint64_t, 3> sums{};
  std::uint64_t counted = 0;
  for (int x = 0; x < width; ++x, pixels += 3) {
    const std::uint32_t counts = brightness[x] == brightness[x] ? 1U : 0U;
    for (std::size_t c = 0; c < 3; ++c) sums[c] += static_cast<std::uint64_t>(counts) * pixels[c];
    counted += counts;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    colours.sums[c] += static_cast<double>(sums[c]) / std::numeric_limits<Sample>::max();
  }
  colours.counted += static_cast<double>(counted);
  colours.clipped += static_cast<double>(static_cast<std::uint64_t>(width) - counted);
}

cv::Rect grown(const cv::Rect& part, int by) {
  return {part.x - by, part.y - by, part.width + 2 * by, part.height + 2 * by};
}

/// Of a frame, around the middle of a tile.
cv::Rect middle_of(const cv::Rect& tile, cv::Size frame) {
  const cv::Rect whole = grown(tile, kReach);
  const int width = std::min(whole.width, kMostMiddle);
  const int height = std::min(whole.height, kMostMiddle);
  return cv::Rect(whole.x + (whole.width - width) / 2, whole.y + (whole.height - height) / 2, width,
                  height) &
         cv::Rect({0, 0}, frame);
}

BrightnessPlane cut(const BrightnessPlane& plane, const cv::Rect& part) {
  BrightnessPlane out;
  out.resize(part.width, part.height);
  for (int y = 0; y < part.height; ++y) {
    std::copy_n(plane.row(part.y + y) + part.x, part.width, out.row(y));
  }
  return out;
}

/// Measures one tile after the other; what it needs of memory it keeps.
class TileMeasurer {
 public:
  TileMeasurer(const cv::Mat& image, const ClippingLevels& levels)
      : image_(image), levels_(levels) {}

  TileMeasures measure(const cv::Rect& tile, BrightnessPlane& middle) {
    const cv::Rect seen = grown(tile, kReach) & cv::Rect({0, 0}, image_.size());
    take_brightness(image_, seen, levels_, plane_);
    const Colours colours = image_.depth() == CV_16U ? colours_of<std::uint16_t>(seen, tile)
                                                     : colours_of<std::uint8_t>(seen, tile);
    TileMeasures measures;
    for (std::size_t c = 0; c < 3; ++c) measures.mean[c] = colours.mean(c);
    measures.clipped = colours.clipped / static_cast<double>(tile.area());
    const MeasuredDetail found = detail_.measure(plane_, tile - seen.tl());
    measures.energy = found.energy;
    measures.white_variance = found.noise_variance;
    measures.noise = white_noise(found.noise_variance);
    middle = cut(plane_, middle_of(tile, image_.size()) - seen.tl());
    return measures;
  }

 private:
  template <typename Sample>
  Colours colours_of(const cv::Rect& seen, const cv::Rect& tile) const {
    Colours colours;
    for (int y = tile.y; y < tile.br().y; ++y) {
      add_colours(image_.ptr<Sample>(y) + 3L * tile.x, plane_.row(y - seen.y) + (tile.x - seen.x),
                  tile.width, colours);
    }
    return colours;
  }

  const cv::Mat& image_;
  const ClippingLevels& levels_;
  BrightnessPlane plane_;
  DetailMeasurer detail_;
};

}  // namespace

double TileMeasures::signal_to_noise() const {
  constexpr double kLeast = 1e-12;  // of a picture without any noise
  return detail(DetailBand::fine).sum() / std::max(2.0 * noise[DetailBand::fine], kLeast);
}

FrameMeasures measure_frame(const cv::Mat& image) {
  FrameMeasures measures{TileGrid::of(image.size()), {}, clipping_levels(image)};
  measures.tiles.resize(static_cast<std::size_t>(measures.grid.count()));
  auto middles = std::make_shared<TileMiddles>(measures.tiles.size());
  cv::parallel_for_({0, measures.grid.count()}, [&](const cv::Range& tiles) {
    TileMeasurer measurer(image, measures.clipping);
    for (int number = tiles.start; number < tiles.end; ++number) {
      const auto index = static_cast<std::size_t>(number);
      measures.tiles[index] = measurer.measure(measures.grid.tile(number), (*middles)[index]);
    }
  });
  measures.middles = std::move(middles);
  return measures;
}

}  // namespace biotomy::acquisition
