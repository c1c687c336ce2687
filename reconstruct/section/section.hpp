#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "reconstruct/bricks/brick_source.hpp"
#include "reconstruct/geometry/plane.hpp"
#include "reconstruct/geometry/section_basis.hpp"
#include "reconstruct/geometry/theta_rectangle.hpp"
#include "reconstruct/section/interpolation.hpp"
#include "reconstruct/section/pixel_grid.hpp"
#include "reconstruct/section/sampler.hpp"

namespace biotomy::reconstruct {

/// How sections are drawn, whatever the plane.
struct SectionStyle {
  ThetaChoice theta = theta::Bounding{};
  Interpolation interpolation = Interpolation::linear;
  std::optional<double> pixel;  ///< micrometres; the least spacing if none
  Colour background{0, 0, 0};
  std::int64_t max_bytes = 2'000'000'000;  ///< of a picture in memory
};

/// One section: a plane and how its picture lies in it.
struct SectionRequest {
  Plane plane;
  SectionBasis basis;
  SectionStyle style;
};

/// A section before it is sampled: cheap, and all that is to be known of it but its colours.
struct SectionOutline {
  std::vector<Vector3> polygon;  ///< where the plane cuts the cuboid
  PixelGrid grid;
};

struct Section {
  SectionOutline outline;
  cv::Mat image;  ///< CV_8UC3 or CV_16UC3, R G B; pixel (0, 0) at outline.grid.rectangle.origin
  SampleStatistics statistics;
};

/// Throws SampleError where the plane does not cut the cuboid, or the picture would be too large,
/// and what theta_rectangle throws.
SectionOutline outline_section(const Cuboid& cuboid, int bits, const SectionRequest& request);

/// Likewise where polygon and rectangle are known: throws only for a picture too large.
SectionOutline outline_section(const Cuboid& cuboid, int bits, const SectionStyle& style,
                               std::vector<Vector3> polygon, const ThetaRectangle& rectangle);

/// Throws what outline_section and sample_grid throw.
Section cut_section(BrickSource& source, const SectionRequest& request, const OnRows& on_rows = {});

}  // namespace biotomy::reconstruct
