#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/geometry/plane.hpp"
#include "reconstruct/geometry/section_basis.hpp"

namespace biotomy::reconstruct {

/// A plane turned about an axis. Angles are in degrees, right-handed about `axis` in the sample
/// frame.
struct Rotation {
  Vector3 axis;                    ///< a direction, of any length
  std::optional<Vector3> through;  ///< a point of the axis and of every plane; the cuboid's centre
  std::optional<Vector3> normal;   ///< of the plane at 0 degrees; if none, z made perpendicular to
                                   ///< the axis, or y where the axis is z
  double from = 0.0;
  double to = 0.0;
  double step = 0.0;
};

/// A plane moved along its normal. Offsets are in micrometres from the plane through `through`.
struct Translation {
  Vector3 normal;                  ///< a direction, of any length
  std::optional<Vector3> through;  ///< (0, 0, 0) if none
  std::optional<double> from;      ///< the least offset of the cuboid if none
  std::optional<double> to;        ///< the greatest offset of the cuboid if none
  double step = 0.0;
};

struct SeriesFrame {
  double value = 0.0;  ///< degrees or micrometres
  Plane plane;
  SectionBasis basis;
  Vector3
      reference;  ///< a point of the plane: of the axis it turns about, or moved along its normal
};

/// The planes of a series, in order. Their bases turn with the planes, rigidly, from the first
/// frame's, so that the picture never flips from one frame to the next; beyond the first frame the
/// rows of a turned `layer` basis leave the layers.
struct Series {
  std::string unit;  ///< of the values: "deg" or "um"
  int integer_digits = 3;
  int decimals = 1;
  std::vector<SeriesFrame> frames;
};

/// Frames at from, from + step … up to `to`, which is included where a step meets it. Throws
/// InvalidRequest when the steps don't lead from one to the other, or are more than 100 000.
Series rotation_series(const Rotation& rotation, BasisKind kind, const Cuboid& cuboid);
Series translation_series(const Translation& translation, BasisKind kind, const Cuboid& cuboid);

/// The frame's value as it stands in its label: "+012.0 deg".
std::string frame_label(const Series& series, std::size_t index);

/// Sorted by name, frames are in order: "000_+012.0deg.png". `extension` has its dot.
std::string frame_file_name(const Series& series, std::size_t index,
                            const std::string& extension = ".png");

}  // namespace biotomy::reconstruct
