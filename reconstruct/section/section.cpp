#include "reconstruct/section/section.hpp"

#include <algorithm>
#include <utility>

#include "reconstruct/geometry/section_polygon.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr int kColours = 3;

double least_spacing(const Cuboid& cuboid) {
  return std::min({cuboid.spacing.x, cuboid.spacing.y, cuboid.spacing.z});
}

}  // namespace

SectionOutline outline_section(const Cuboid& cuboid, int bits, const SectionRequest& request) {
  std::vector<Vector3> polygon = section_polygon(request.plane, cuboid);
  const ThetaRectangle rectangle = theta_rectangle(request.style.theta, polygon, request.basis);
  return outline_section(cuboid, bits, request.style, std::move(polygon), rectangle);
}

SectionOutline outline_section(const Cuboid& cuboid, int bits, const SectionStyle& style,
                               std::vector<Vector3> polygon, const ThetaRectangle& rectangle) {
  return {std::move(polygon), pixel_grid(rectangle, style.pixel.value_or(least_spacing(cuboid)),
                                         kColours * bits / 8, style.max_bytes)};
}

Section cut_section(BrickSource& source, const SectionRequest& request, const OnRows& on_rows) {
  SectionOutline outline = outline_section(source.cuboid(), source.bits(), request);
  SampledImage sampled = sample_grid(source, outline.grid, request.style.interpolation,
                                     request.style.background, on_rows);
  return {std::move(outline), std::move(sampled.image), sampled.statistics};
}

}  // namespace biotomy::reconstruct
