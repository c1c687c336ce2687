#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "reconstruct/geometry/enclosure.hpp"
#include "reconstruct/geometry/inscribed_rectangle.hpp"
#include "reconstruct/geometry/polynomial.hpp"

// Let A(θ) be the area of the largest rectangle at the angle θ. Where it is greatest is found in
// closed form.
//
// At θ the shape (w, h) keeps within the limits a·w + b·h ≤ c of the enclosures. c does not depend
// on θ, and a and b are sums of the components of normals that point forward along the axes. So
// between two angles at which an edge of the polygon lies along an axis, no component changes its
// sign, and with δ from the middle of such an interval and t = tan δ, a = cos δ·(a₀ + a₁·t), and
// likewise b. There are at most six intervals in 90°, in each of which the optimum is one of these:
//  - at an end: a side lies on an edge of the polygon;
//  - with one limit active the area is c²/(4ab). ln a and ln b are concave, being logarithms of
//    positive sinusoids, so that the area has no maximum inside unless another limit comes in;
//  - in the corner of two limits i, k: w = (cᵢbₖ − cₖbᵢ)/D, h = (aᵢcₖ − aₖcᵢ)/D, D = aᵢbₖ − aₖbᵢ.
//    The product of the numerators is cos²δ·P(t) and D is cos²δ·Q(t), with quadratic P and Q, so
//    that A = P·(1 + t²)/Q², which is stationary where (P'·(1 + t²) + 2t·P)·Q = 2·P·(1 + t²)·Q',
//    a polynomial whose fifth power cancels;
//  - where the lines of three limits go through one point: their determinant is quadratic in t;
//  - where the lines of two limits coincide (mirror images do): there Q = 0.
// All these angles are tried: some hundred for a hexagon.

namespace biotomy::reconstruct {
namespace {

constexpr double kEighthTurn = M_PI / 4.0;
constexpr double kQuarterTurn = M_PI / 2.0;

constexpr double kSameArea = 1e-10;    // relative
constexpr double kSameAngle = 1e-9;    // radians
constexpr double kNoAngle = 1e-11;     // radians; of 20 000 pixels less than a millionth of one
constexpr double kNoInterval = 1e-13;  // radians

struct Interval {
  double first;
  double last;

  double middle() const { return 0.5 * (first + last); }
};

// cos δ·(a(t)·width + b(t)·height) ≤ c
struct TurningLimit {
  Polynomial<2> a{};
  Polynomial<2> b{};
  double c = 0.0;
};

// Within (−45°, 45°], and exactly 0 where only rounding says otherwise.
double reduced(double angle) {
  const double remainder = std::remainder(angle, kQuarterTurn);
  if (std::abs(remainder) < kNoAngle) {
    return 0.0;
  }
  return remainder <= -kEighthTurn + kSameAngle ? remainder + kQuarterTurn : remainder;
}

std::vector<double> flush_angles(const std::vector<HalfPlane>& sides) {
  std::vector<double> angles;
  angles.reserve(sides.size());
  for (const HalfPlane& side : sides) {
    angles.push_back(reduced(std::atan2(side.b, side.a)));
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

// From each angle to the next, and from the last to the first one a quarter turn on.
std::vector<Interval> intervals_between(const std::vector<double>& angles) {
  std::vector<Interval> intervals;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next = i + 1 < angles.size() ? angles[i + 1] : angles.front() + kQuarterTurn;
    if (next - angles[i] > kNoInterval) {
      intervals.push_back({angles[i], next});
    }
  }
  return intervals;
}

TurningLimit turning_limit(const Enclosure& enclosure, const std::vector<HalfPlane>& sides) {
  TurningLimit limit{{}, {}, enclosure.c};
  for (std::size_t i = 0; i < enclosure.sides.size(); ++i) {
    const HalfPlane& side = sides[enclosure.sides[i]];
    if (side.a > 0.0) {
      limit.a = sum(limit.a, enclosure.weights[i], {side.a, side.b});
    }
    if (side.b > 0.0) {
      limit.b = sum(limit.b, enclosure.weights[i], {side.b, -side.a});
    }
  }
  return limit;
}

Polynomial<3> determinant(const TurningLimit& i, const TurningLimit& k) {
  return sum(product(i.a, k.b), -1.0, product(k.a, i.b));
}

Polynomial<3> determinant(const TurningLimit& i, const TurningLimit& k, const TurningLimit& l) {
  const Polynomial<3> first = sum({}, i.c, determinant(k, l));
  return sum(sum(first, -k.c, determinant(i, l)), l.c, determinant(i, k));
}

// (P'·(1 + t²) + 2t·P)·Q − 2·P·(1 + t²)·Q', without its fifth power.
Polynomial<5> stationary(const TurningLimit& i, const TurningLimit& k) {
  const Polynomial<2> width = sum(sum({}, i.c, k.b), -k.c, i.b);
  const Polynomial<2> height = sum(sum({}, k.c, i.a), -i.c, k.a);
  const Polynomial<3> p = product(width, height);
  const Polynomial<3> q = determinant(i, k);
  const Polynomial<3> one_and_square{1.0, 0.0, 1.0};
  const Polynomial<4> slope =
      sum(product(derivative(p), one_and_square), 2.0, product(p, Polynomial<2>{0.0, 1.0}));
  const Polynomial<6> all =
      sum(product(slope, q), -2.0, product(product(p, one_and_square), derivative(q)));
  return {all[0], all[1], all[2], all[3], all[4]};
}

/// Gathers the angles of an interval at which the area can be greatest.
class Candidates {
 public:
  Candidates(const Interval& interval, std::vector<double>& angles)
      : interval_(interval), angles_(angles) {}

  template <std::size_t N>
  void add_roots(const Polynomial<N>& f) {
    const double end = std::tan(0.5 * (interval_.last - interval_.first));
    for (const double root : roots_between(f, -end, end)) {
      angles_.push_back(reduced(interval_.middle() + std::atan(root)));
    }
  }

 private:
  Interval interval_;
  std::vector<double>& angles_;
};

void add_candidates(const Interval& interval, const std::vector<HalfPlane>& sides,
                    const std::vector<Enclosure>& enclosures, std::vector<double>& angles) {
  std::vector<TurningLimit> limits;
  limits.reserve(enclosures.size());
  const std::vector<HalfPlane> in_the_middle = turned(sides, interval.middle());
  for (const Enclosure& enclosure : enclosures) {
    limits.push_back(turning_limit(enclosure, in_the_middle));
  }
  Candidates candidates(interval, angles);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      candidates.add_roots(determinant(limits[i], limits[k]));
      candidates.add_roots(stationary(limits[i], limits[k]));
      for (std::size_t l = 0; l < k; ++l) {
        candidates.add_roots(determinant(limits[i], limits[k], limits[l]));
      }
    }
  }
}

double area_at(double angle, const std::vector<HalfPlane>& sides,
               const std::vector<Enclosure>& enclosures) {
  return largest_shape(limits_of(enclosures, turned(sides, angle))).area();
}

bool nearer_to_zero(double angle, double other) {
  const double difference = std::abs(angle) - std::abs(other);
  return difference < -kSameAngle || (difference < kSameAngle && angle > other);
}

}  // namespace

PlanarRectangle largest_rectangle_at_any_angle(const PlanarPolygon& polygon) {
  const std::vector<HalfPlane>& sides = polygon.sides();
  const std::vector<Enclosure> all = enclosures(sides);
  std::vector<double> angles = flush_angles(sides);
  for (const Interval& interval : intervals_between(angles)) {
    add_candidates(interval, sides, all, angles);
  }
  std::vector<double> areas;
  areas.reserve(angles.size());
  for (const double angle : angles) {
    areas.push_back(area_at(angle, sides, all));
  }
  const double enough = (1.0 - kSameArea) * *std::max_element(areas.begin(), areas.end());
  double chosen = M_PI;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    if (areas[i] >= enough && nearer_to_zero(angles[i], chosen)) {
      chosen = angles[i];
    }
  }
  return largest_rectangle(polygon, chosen);
}

}  // namespace biotomy::reconstruct
