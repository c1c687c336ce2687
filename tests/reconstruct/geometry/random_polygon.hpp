#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "reconstruct/geometry/cuboid.hpp"
#include "reconstruct/geometry/planar_polygon.hpp"
#include "reconstruct/geometry/plane.hpp"
#include "reconstruct/geometry/section_basis.hpp"
#include "reconstruct/geometry/section_polygon.hpp"

namespace biotomy::tests {

/// A convex polygon of 3 to 6 vertices, wide or narrow, beginning at (0, 0).
inline std::vector<reconstruct::PlanarPoint> random_polygon(std::mt19937& random) {
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const std::size_t count = 3 + random() % 4;
  const double narrow = std::pow(10.0, -2.0 * part(random));
  const double lean = 2.0 * M_PI * part(random);
  std::vector<double> angles;
  for (std::size_t i = 0; i < count; ++i) {
    angles.push_back(2.0 * M_PI * part(random));
  }
  std::sort(angles.begin(), angles.end());
  std::vector<reconstruct::PlanarPoint> points;
  for (const double angle : angles) {
    const double x = 100.0 * std::cos(angle);
    const double y = 100.0 * narrow * std::sin(angle);
    points.push_back(
        {x * std::cos(lean) - y * std::sin(lean), x * std::sin(lean) + y * std::cos(lean)});
  }
  for (std::size_t i = count; i-- > 0;) {
    points[i] = {points[i].x - points[0].x, points[i].y - points[0].y};
  }
  return points;
}

/// A box of 2 to 2000 voxels along each axis, with spacings that differ up to a hundredfold.
inline reconstruct::Cuboid random_cuboid(std::mt19937& random) {
  std::uniform_real_distribution<double> power(0.0, 1.0);
  const auto size = [&] {
    return static_cast<std::int64_t>(2.0 * std::pow(1000.0, power(random)));
  };
  const auto spacing = [&] { return std::pow(100.0, power(random)); };
  return {{size(), size(), size()}, {spacing(), spacing(), spacing()}};
}

/// A plane through a random point of the box, in any direction.
inline reconstruct::Plane random_plane(const reconstruct::Cuboid& cuboid, std::mt19937& random) {
  std::normal_distribution<double> direction;
  std::uniform_real_distribution<double> part(0.01, 0.99);
  const reconstruct::Vector3 far = cuboid.extent();
  return reconstruct::Plane::from_normal(
      {direction(random) / far.x, direction(random) / far.y, direction(random) / far.z},
      {part(random) * far.x, part(random) * far.y, part(random) * far.z});
}

/// Its section polygon by its coordinates along the `layer` basis, beginning at (0, 0).
inline std::vector<reconstruct::PlanarPoint> random_section(std::mt19937& random) {
  const reconstruct::Cuboid cuboid = random_cuboid(random);
  const reconstruct::Plane plane = random_plane(cuboid, random);
  const reconstruct::SectionBasis basis =
      reconstruct::section_basis(reconstruct::BasisKind::layer, plane);
  const auto polygon = reconstruct::section_polygon(plane, cuboid);
  std::vector<reconstruct::PlanarPoint> points;
  points.reserve(polygon.size());
  for (const reconstruct::Vector3& vertex : polygon) {
    points.push_back({reconstruct::dot(vertex - polygon[0], basis.p),
                      reconstruct::dot(vertex - polygon[0], basis.q)});
  }
  return points;
}

}  // namespace biotomy::tests
