#include "reconstruct/section/series_layout.hpp"

#include <cstddef>
#include <utility>
#include <variant>

#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/section_polygon.hpp"
#include "reconstruct/section/picture_alignment.hpp"

namespace biotomy::reconstruct {
namespace {

/// What is to be seen at rest. A custom rectangle was asked for where it is: its own corner.
Vector3 reference_of(const SeriesFrame& frame, const SectionOutline& outline,
                     const ThetaChoice& choice) {
  return std::holds_alternative<theta::Custom>(choice) ? outline.grid.rectangle.origin
                                                       : frame.reference;
}

}  // namespace

FrameOutline frame_outline(const SeriesFrame& frame, const Cuboid& cuboid, int bits,
                           const SectionStyle& style) {
  std::vector<Vector3> polygon = contact(frame.plane, cuboid).vertices;
  if (polygon.size() < 3) {
    return {};
  }
  ThetaRectangle rectangle;
  try {
    rectangle = theta_rectangle(style.theta, polygon, frame.basis);
  } catch (const InvalidRequest&) {
    return {std::nullopt, std::current_exception()};
  } catch (const SampleError&) {
    return {std::nullopt, std::current_exception()};
  }
  return {outline_section(cuboid, bits, style, std::move(polygon), rectangle), nullptr};
}

SeriesLayout series_layout(const Cuboid& cuboid, int bits, const Series& series,
                           const SectionStyle& style) {
  SeriesLayout layout;
  std::vector<PictureInSequence> pictures;
  std::exception_ptr refusal;
  for (const SeriesFrame& frame : series.frames) {
    FrameOutline each = frame_outline(frame, cuboid, bits, style);
    refusal = refusal ? refusal : each.refusal;
    layout.outlines.push_back(std::move(each.outline));
    if (const auto& outline = layout.outlines.back()) {
      pictures.push_back({outline->grid, reference_of(frame, *outline, style.theta)});
    }
  }
  if (pictures.empty()) {
    if (refusal) {
      std::rethrow_exception(refusal);
    }
    throw SampleError("no plane of the series cuts the sample: check its axis, point and range");
  }
  const AlignedPictures aligned = align_pictures(pictures);
  layout.places.resize(layout.outlines.size());
  auto picture = aligned.pictures.begin();
  for (std::size_t i = 0; i < layout.outlines.size(); ++i) {
    if (auto& outline = layout.outlines[i]) {
      outline->grid = picture->grid;
      layout.places[i] = picture->first;
      ++picture;
    }
  }
  layout.size = aligned.size;
  layout.pixel = pictures.front().grid.pixel;
  return layout;
}

}  // namespace biotomy::reconstruct
