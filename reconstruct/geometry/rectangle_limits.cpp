#include "reconstruct/geometry/rectangle_limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "reconstruct/geometry/exact_cross.hpp"

namespace biotomy::reconstruct {
namespace {

// Candidates are only the ratio of the sides; each is made as large as all limits allow. So none
// has to be tested for being within them, and a rounding error of the ratio costs no more than it
// is itself.
RectangleShape as_large_as_allowed(RectangleShape ratio, std::span<const RectangleLimit> limits) {
  if (!(ratio.width > 0.0 && ratio.height > 0.0)) {
    return {};
  }
  double factor = std::numeric_limits<double>::infinity();
  for (const RectangleLimit& limit : limits) {
    factor = std::min(factor, limit.c / (limit.a * ratio.width + limit.b * ratio.height));
  }
  if (!std::isfinite(factor) || factor <= 0.0) {
    return {};
  }
  return {factor * ratio.width, factor * ratio.height};
}

// Where the lines of both limits cross (Cramer's rule, without the common denominator).
RectangleShape corner(const RectangleLimit& one, const RectangleLimit& other) {
  const double width = exact_cross(one.c, one.b, other.c, other.b);
  const double height = exact_cross(one.a, one.c, other.a, other.c);
  return width < 0.0 ? RectangleShape{-width, -height} : RectangleShape{width, height};
}

}  // namespace

RectangleShape largest_shape(std::span<const RectangleLimit> limits) {
  RectangleShape largest;
  const auto consider = [&](const RectangleShape& ratio) {
    const RectangleShape shape = as_large_as_allowed(ratio, limits);
    if (shape.area() > largest.area()) {
      largest = shape;
    }
  };
  for (std::size_t i = 0; i < limits.size(); ++i) {
    consider({limits[i].b, limits[i].a});
    for (std::size_t k = 0; k < i; ++k) {
      consider(corner(limits[i], limits[k]));
    }
  }
  return largest;
}

}  // namespace biotomy::reconstruct
