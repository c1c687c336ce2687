#include "reconstruct/section/series_frames.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/section_polygon.hpp"

namespace biotomy::reconstruct {
namespace {

using Outlines = std::vector<std::optional<SectionOutline>>;

Outlines outlines_of(const BrickSource& source, const Series& series, const SectionStyle& style) {
  Outlines outlines;
  for (const SeriesFrame& frame : series.frames) {
    const bool cuts = contact(frame.plane, source.cuboid()).vertices.size() >= 3;
    outlines.push_back(cuts ? std::optional(outline_section(source.cuboid(), source.bits(),
                                                            {frame.plane, frame.basis, style}))
                            : std::nullopt);
  }
  return outlines;
}

cv::Size size_of(const SectionOutline& outline) {
  return {outline.grid.columns, outline.grid.rows};
}

cv::Size largest(const Outlines& outlines) {
  cv::Size size;
  for (const auto& outline : outlines) {
    if (outline) {
      size.width = std::max(size.width, outline->grid.columns);
      size.height = std::max(size.height, outline->grid.rows);
    }
  }
  if (size.empty()) {
    throw SampleError("no plane of the series cuts the sample: check its axis, point and range");
  }
  return size;
}

double pixel_of(const Outlines& outlines) {
  const auto cut = std::find_if(outlines.begin(), outlines.end(),
                                [](const auto& outline) { return outline.has_value(); });
  return cut == outlines.end() ? 0.0 : (*cut)->grid.pixel;
}

std::string longest_label(const Series& series) {
  std::string longest;
  for (std::size_t i = 0; i < series.frames.size(); ++i) {
    longest = std::max(longest, frame_label(series, i),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  }
  return longest;
}

FrameCanvas canvas_for(const Outlines& outlines, const Series& series, const Colour& background,
                       FrameMarks marks) {
  const cv::Size size = largest(outlines);
  std::optional<ScaleBar> bar;
  if (marks.scale_bar) {
    bar = scale_bar(size.width, pixel_of(outlines));
  }
  return {size, marks.label ? longest_label(series) : "", background, bar};
}

}  // namespace

SeriesFrames::SeriesFrames(BrickSource& source, Series series, const SectionStyle& style,
                           FrameMarks marks)
    : source_(source),
      series_(std::move(series)),
      style_(style),
      marks_(marks),
      outlines_(outlines_of(source, series_, style)),
      pixel_(pixel_of(outlines_)),
      canvas_(canvas_for(outlines_, series_, style.background, marks)) {
  const double bytes = static_cast<double>(canvas_.size().width) * canvas_.size().height *
                       static_cast<double>(CV_ELEM_SIZE(frame_type()));
  if (bytes > static_cast<double>(style.max_bytes)) {
    throw SampleError("the frames of the series are too large for memory: ask for a larger pixel");
  }
}

int SeriesFrames::frame_type() const {
  return source_.bits() == 16 ? CV_16UC3 : CV_8UC3;
}

const std::optional<SectionOutline>& SeriesFrames::outline(std::size_t index) const {
  return outlines_.at(index);
}

cv::Point SeriesFrames::first_pixel(std::size_t index) const {
  return canvas_.place_of(size_of(outlines_.at(index).value()));
}

std::string SeriesFrames::label(std::size_t index) const {
  return marks_.label ? frame_label(series_, index) : "";
}

SampledImage SeriesFrames::draw(std::size_t index, const OnRows& on_rows) const {
  const std::optional<SectionOutline>& outline = outlines_.at(index);
  if (!outline) {
    return {canvas_.draw_empty(frame_type(), label(index)), {}};
  }
  const SampledImage sampled =
      sample_grid(source_, outline->grid, style_.interpolation, style_.background, on_rows);
  return {canvas_.draw(sampled.image, label(index)), sampled.statistics};
}

}  // namespace biotomy::reconstruct
