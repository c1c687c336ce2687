#include "reconstruct/section/series_frames.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

std::string longest_label(const Series& series) {
  std::string longest;
  for (std::size_t i = 0; i < series.frames.size(); ++i) {
    longest = std::max(longest, frame_label(series, i),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  }
  return longest;
}

FrameCanvas canvas_for(const SeriesLayout& layout, const Series& series, const Colour& background,
                       FrameMarks marks) {
  std::optional<ScaleBar> bar;
  if (marks.scale_bar) {
    bar = scale_bar(layout.size.width, layout.pixel);
  }
  return {layout.size, marks.label ? longest_label(series) : "", background, bar};
}

}  // namespace

SeriesFrames::SeriesFrames(BrickSource& source, Series series, const SectionStyle& style,
                           FrameMarks marks)
    : source_(source),
      series_(std::move(series)),
      style_(style),
      marks_(marks),
      layout_(series_layout(source.cuboid(), source.bits(), series_, style)),
      canvas_(canvas_for(layout_, series_, style.background, marks)) {
  if (canvas_.bytes(frame_type()) > static_cast<double>(style.max_bytes)) {
    throw SampleError("the frames of the series are too large for memory: ask for a larger pixel");
  }
}

int SeriesFrames::frame_type() const {
  return source_.bits() == 16 ? CV_16UC3 : CV_8UC3;
}

const std::optional<SectionOutline>& SeriesFrames::outline(std::size_t index) const {
  return layout_.outlines.at(index);
}

cv::Point SeriesFrames::first_pixel(std::size_t index) const {
  return canvas_.place_of(layout_.size) + layout_.places.at(index);
}

std::string SeriesFrames::label(std::size_t index) const {
  return marks_.label ? frame_label(series_, index) : "";
}

SampledImage SeriesFrames::draw(std::size_t index, const OnRows& on_rows) const {
  SampledImage frame{canvas_.draw_empty(frame_type(), label(index)), {}};
  if (const std::optional<SectionOutline>& outline = layout_.outlines.at(index)) {
    const PixelGrid& grid = outline->grid;
    cv::Mat picture =
        canvas_.part_for({first_pixel(index), cv::Size(grid.columns, grid.rows)}, frame.image);
    frame.statistics =
        sample_grid(source_, grid, style_.interpolation, style_.background, picture, on_rows);
  }
  return frame;
}

}  // namespace biotomy::reconstruct
