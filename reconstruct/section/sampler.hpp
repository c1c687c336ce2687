#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/bricks/brick_source.hpp"
#include "reconstruct/section/interpolation.hpp"
#include "reconstruct/section/pixel_grid.hpp"

namespace biotomy::reconstruct {

/// Red, green and blue of 8 bits; in a picture of 16 bits each level is 257 times as high.
using Colour = std::array<std::uint8_t, 3>;

struct SampleStatistics {
  std::int64_t chunks_touched = 0;  ///< different ones
  std::vector<int> levels;          ///< of the pyramid that were read: one or two, finest first
  double sample_s = 0.0;            ///< of planning and sampling, all threads' added up
};

struct SampledImage {
  cv::Mat image;  ///< CV_8UC3 or CV_16UC3 as the source has bits, R G B
  SampleStatistics statistics;
};

/// Is told how far a picture is. A picture that is mixed from two levels has its rows twice. What
/// it throws ends the work.
using OnRows = std::function<void(std::int64_t done, std::int64_t total)>;

/// The colours of the source at the pixel centres of `grid`, from the levels that level_choice
/// names; `background` where a centre is outside the cuboid by more than VoxelRow forgives. Strips
/// of the picture follow each other, the tiles of one are filled in parallel while the bricks of
/// the next are fetched; the result does not depend on how. `on_rows` is called after each strip,
/// by the caller's thread. Throws what the source and `on_rows` throw.
SampledImage sample_grid(BrickSource& source, const PixelGrid& grid, Interpolation kind,
                         const Colour& background, const OnRows& on_rows = {});

/// Likewise into `image`, which keeps its memory where it has the right size and type already: for
/// pictures that follow each other, as new memory costs as much as sampling does.
SampleStatistics sample_grid(BrickSource& source, const PixelGrid& grid, Interpolation kind,
                             const Colour& background, cv::Mat& image, const OnRows& on_rows = {});

}  // namespace biotomy::reconstruct
