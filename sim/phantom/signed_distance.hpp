#pragma once

#include <algorithm>
#include <cmath>

namespace biotomy::sim {

/// Signed distances to simple outlines in the plane, negative inside
/// (forms after I. Quilez, "2D distance functions").

inline float length(float x, float y) {
  return std::sqrt(x * x + y * y);
}

inline float to_circle(float x, float y, float radius) {
  return length(x, y) - radius;
}

/// First-order estimate |f|/|grad f|: good near the outline, of the right sign everywhere.
inline float to_ellipse(float x, float y, float half_width, float half_height) {
  const float ex = x / half_width;
  const float ey = y / half_height;
  const float k0 = length(ex, ey);
  const float k1 = length(ex / half_width, ey / half_height);
  return k1 > 0.0F ? k0 * (k0 - 1.0F) / k1 : -std::min(half_width, half_height);
}

inline float to_rounded_box(float x, float y, float half_width, float half_height, float corner) {
  const float qx = std::fabs(x) - half_width + corner;
  const float qy = std::fabs(y) - half_height + corner;
  return length(std::max(qx, 0.0F), std::max(qy, 0.0F)) + std::min(std::max(qx, qy), 0.0F) - corner;
}

/// A band of the given half width around the segment a–b.
inline float to_band(float x, float y, float ax, float ay, float bx, float by, float half_width) {
  const float dx = bx - ax;
  const float dy = by - ay;
  const float along = std::clamp(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0.0F, 1.0F);
  return length(x - ax - along * dx, y - ay - along * dy) - half_width;
}

/// The union of two outlines with their corner filled over the length `blend`.
inline float smooth_union(float a, float b, float blend) {
  const float h = std::max(blend - std::fabs(a - b), 0.0F) / blend;
  return std::min(a, b) - h * h * blend * 0.25F;
}

/// 0 below `from`, 1 above `to`, with a smooth step between.
inline float smooth_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

}  // namespace biotomy::sim
