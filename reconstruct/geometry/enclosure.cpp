#include "reconstruct/geometry/enclosure.hpp"

#include <algorithm>
#include <cmath>

#include "reconstruct/geometry/exact_cross.hpp"

namespace biotomy::reconstruct {
namespace {

// Of the sine between two normals: what rounding leaves between opposite ones.
constexpr double kParallel = 1e-15;

double sine(const HalfPlane& from, const HalfPlane& to) {
  return exact_cross(from.a, from.b, to.a, to.b);
}

bool opposite(const HalfPlane& one, const HalfPlane& other) {
  return std::abs(sine(one, other)) <= kParallel && one.a * other.a + one.b * other.b < 0.0;
}

}  // namespace

std::vector<Enclosure> enclosures(std::span<const HalfPlane> sides) {
  std::vector<Enclosure> found;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (std::size_t j = i + 1; j < sides.size(); ++j) {
      if (opposite(sides[i], sides[j])) {
        found.push_back({{i, j, j}, {1.0, 1.0, 0.0}, sides[i].c + sides[j].c});
      }
      for (std::size_t k = j + 1; k < sides.size(); ++k) {
        const double wi = sine(sides[j], sides[k]);
        const double wj = sine(sides[k], sides[i]);
        const double wk = sine(sides[i], sides[j]);
        if (std::min({wi, wj, wk}) > kParallel) {
          found.push_back(
              {{i, j, k}, {wi, wj, wk}, wi * sides[i].c + wj * sides[j].c + wk * sides[k].c});
        }
      }
    }
  }
  return found;
}

std::vector<RectangleLimit> limits_of(std::span<const Enclosure> enclosures,
                                      std::span<const HalfPlane> sides) {
  std::vector<RectangleLimit> limits;
  limits.reserve(enclosures.size());
  for (const Enclosure& enclosure : enclosures) {
    RectangleLimit limit{0.0, 0.0, enclosure.c};
    for (std::size_t i = 0; i < enclosure.sides.size(); ++i) {
      const HalfPlane& side = sides[enclosure.sides[i]];
      limit.a += enclosure.weights[i] * std::max(side.a, 0.0);
      limit.b += enclosure.weights[i] * std::max(side.b, 0.0);
    }
    limits.push_back(limit);
  }
  return limits;
}

}  // namespace biotomy::reconstruct
