#include "reconstruct/geometry/theta_rectangle.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "reconstruct/errors.hpp"
#include "reconstruct/geometry/inscribed_rectangle.hpp"
#include "reconstruct/geometry/planar_polygon.hpp"

namespace biotomy::reconstruct {
namespace {

struct Direction {
  double cosine;
  double sine;
};

// Right angles are exact.
Direction direction_of(double degrees) {
  const double angle = std::remainder(degrees, 360.0);
  const Direction direction{std::cos(angle * M_PI / 180.0), std::sin(angle * M_PI / 180.0)};
  if (std::remainder(angle, 90.0) == 0.0) {
    return {std::round(direction.cosine), std::round(direction.sine)};
  }
  return direction;
}

SectionBasis turned(const SectionBasis& basis, const Direction& direction) {
  return {direction.cosine * basis.p + direction.sine * basis.q,
          direction.cosine * basis.q - direction.sine * basis.p};
}

/// Makes the rectangle of a section polygon by each of the rules. Coordinates are taken from the
/// first vertex, not from the sample's corner: where the rectangle starts at that vertex, as it
/// does in a section along a layer, its origin is exact.
class Chooser {
 public:
  Chooser(std::span<const Vector3> polygon, const SectionBasis& basis)
      : polygon_(polygon), basis_(basis) {}

  ThetaRectangle operator()(const theta::Bounding&) const {
    PlanarPoint least;
    PlanarPoint most;
    for (const PlanarPoint& point : points()) {
      least = {std::min(least.x, point.x), std::min(least.y, point.y)};
      most = {std::max(most.x, point.x), std::max(most.y, point.y)};
    }
    return placed({0.0, least, most.x - least.x, most.y - least.y});
  }

  ThetaRectangle operator()(const theta::Inscribed&) const {
    return placed(largest_rectangle(planar(), 0.0));
  }

  ThetaRectangle operator()(const theta::InscribedAny&) const {
    return placed(largest_rectangle_at_any_angle(planar()));
  }

  ThetaRectangle operator()(const theta::InscribedAtEdge& choice) const {
    const std::size_t edges = polygon_.size();
    if (choice.edge < 0 || static_cast<std::size_t>(choice.edge) >= edges) {
      throw InvalidRequest("the section has no edge " + std::to_string(choice.edge) + ": it has " +
                           std::to_string(edges) + ", numbered 0 to " + std::to_string(edges - 1));
    }
    return placed(largest_rectangle_on_edge(planar(), static_cast<std::size_t>(choice.edge)));
  }

  ThetaRectangle operator()(const theta::Custom& choice) const {
    const bool sizes = choice.width > 0.0 && choice.height > 0.0 && std::isfinite(choice.width) &&
                       std::isfinite(choice.height);
    if (!sizes || !std::isfinite(choice.angle_degrees) || !std::isfinite(norm(choice.corner))) {
      throw InvalidRequest(
          "a custom rectangle needs a corner, a width and a height above 0, and an angle, all of "
          "them finite");
    }
    const Vector3 normal = cross(basis_.p, basis_.q);
    const double off_plane = dot(choice.corner - polygon_.front(), normal);
    return {choice.corner - off_plane * normal, turned(basis_, direction_of(choice.angle_degrees)),
            choice.width, choice.height};
  }

 private:
  std::vector<PlanarPoint> points() const {
    std::vector<PlanarPoint> points;
    points.reserve(polygon_.size());
    for (const Vector3& vertex : polygon_) {
      const Vector3 from_first = vertex - polygon_.front();
      points.push_back({dot(from_first, basis_.p), dot(from_first, basis_.q)});
    }
    return points;
  }

  PlanarPolygon planar() const { return PlanarPolygon(points()); }

  ThetaRectangle placed(const PlanarRectangle& rectangle) const {
    const SectionBasis axes =
        turned(basis_, {std::cos(rectangle.angle), std::sin(rectangle.angle)});
    return {polygon_.front() + rectangle.corner.x * axes.p + rectangle.corner.y * axes.q, axes,
            rectangle.width, rectangle.height};
  }

  std::span<const Vector3> polygon_;
  const SectionBasis& basis_;
};

}  // namespace

ThetaRectangle theta_rectangle(const ThetaChoice& choice, std::span<const Vector3> polygon,
                               const SectionBasis& basis) {
  return std::visit(Chooser(polygon, basis), choice);
}

}  // namespace biotomy::reconstruct
