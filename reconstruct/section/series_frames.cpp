#include "reconstruct/section/series_frames.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/section_polygon.hpp"

namespace biotomy::reconstruct {
namespace {

std::vector<std::optional<PixelGrid>> grids_of(const BrickSource& source, const Series& series,
                                               const SectionStyle& style) {
  std::vector<std::optional<PixelGrid>> grids;
  for (const SeriesFrame& frame : series.frames) {
    const bool cuts = contact(frame.plane, source.cuboid()).vertices.size() >= 3;
    grids.push_back(cuts ? std::optional(outline_section(source.cuboid(), source.bits(),
                                                         {frame.plane, frame.basis, style})
                                             .grid)
                         : std::nullopt);
  }
  return grids;
}

cv::Size largest(const std::vector<std::optional<PixelGrid>>& grids) {
  cv::Size size;
  for (const auto& grid : grids) {
    if (grid) {
      size.width = std::max(size.width, grid->columns);
      size.height = std::max(size.height, grid->rows);
    }
  }
  if (size.empty()) {
    throw SampleError("no plane of the series cuts the sample: check its axis, point and range");
  }
  return size;
}

std::string longest_label(const Series& series) {
  std::string longest;
  for (std::size_t i = 0; i < series.frames.size(); ++i) {
    longest = std::max(longest, frame_label(series, i),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  }
  return longest;
}

int type_of(const BrickSource& source) {
  return source.bits() == 16 ? CV_16UC3 : CV_8UC3;
}

}  // namespace

SeriesFrames::SeriesFrames(BrickSource& source, Series series, const SectionStyle& style)
    : source_(source),
      series_(std::move(series)),
      style_(style),
      grids_(grids_of(source, series_, style)),
      canvas_(largest(grids_), longest_label(series_), style.background) {
  const auto cut =
      std::find_if(grids_.begin(), grids_.end(), [](const auto& grid) { return grid.has_value(); });
  pixel_ = (*cut)->pixel;
  const double bytes = static_cast<double>(canvas_.size().width) * canvas_.size().height *
                       static_cast<double>(CV_ELEM_SIZE(type_of(source)));
  if (bytes > static_cast<double>(style.max_bytes)) {
    throw SampleError("the frames of the series are too large for memory: ask for a larger pixel");
  }
}

cv::Mat SeriesFrames::draw(std::size_t index) const {
  const std::string label = frame_label(series_, index);
  const std::optional<PixelGrid>& grid = grids_.at(index);
  if (!grid) {
    return canvas_.draw_empty(type_of(source_), label);
  }
  const SampledImage sampled = sample_grid(source_, *grid, style_.interpolation, style_.background);
  return canvas_.draw(sampled.image, label);
}

}  // namespace biotomy::reconstruct
