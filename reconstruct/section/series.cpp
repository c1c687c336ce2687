#include "reconstruct/section/series.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr double kMostFrames = 100'000;
constexpr double kWholeStep = 1e-9;
constexpr int kLeastDecimals = 1;
constexpr int kMostDecimals = 6;
constexpr int kLeastDigits = 3;
constexpr double kAlongAxis = 1e-6;

std::vector<double> values_between(double from, double to, double step) {
  if (!std::isfinite(from) || !std::isfinite(to) || !std::isfinite(step)) {
    throw InvalidRequest("from, to and step of a series must be finite numbers");
  }
  if (from == to) {
    return {from};
  }
  const double steps = (to - from) / step;
  if (!(steps >= 0.0)) {
    throw InvalidRequest("the step of a series must lead from its first value towards its last");
  }
  const double count = std::floor(steps + kWholeStep) + 1.0;
  if (count > kMostFrames) {
    throw InvalidRequest("a series has at most 100000 frames: make its step larger");
  }
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < static_cast<int>(count); ++i) {
    values.push_back(from + i * step);
  }
  return values;
}

int decimals_of(double value) {
  for (int decimals = kLeastDecimals; decimals < kMostDecimals; ++decimals) {
    const double scaled = value * std::pow(10.0, decimals);
    if (std::abs(scaled - std::round(scaled)) < 1e-6) {
      return decimals;
    }
  }
  return kMostDecimals;
}

Series empty_series(const std::string& unit, const std::vector<double>& values) {
  Series series{unit, kLeastDigits, kLeastDecimals, {}};
  const double step = values.size() > 1 ? values[1] - values[0] : 0.0;
  series.decimals = std::max(decimals_of(values.front()), decimals_of(step));
  for (const double value : {values.front(), values.back()}) {
    const double rounded = std::round(std::abs(value));
    if (rounded >= 1.0) {
      series.integer_digits =
          std::max(series.integer_digits, static_cast<int>(std::log10(rounded)) + 1);
    }
  }
  return series;
}

/// Turns by an angle about a direction (Rodrigues' formula). Right angles are exact.
class Turn {
 public:
  Turn(const Vector3& unit_axis, double degrees) : axis_(unit_axis) {
    const double angle = std::remainder(degrees, 360.0);
    const bool right = std::remainder(angle, 90.0) == 0.0;
    cosine_ = right ? std::round(std::cos(angle * M_PI / 180.0)) : std::cos(angle * M_PI / 180.0);
    sine_ = right ? std::round(std::sin(angle * M_PI / 180.0)) : std::sin(angle * M_PI / 180.0);
  }

  Vector3 operator()(const Vector3& v) const {
    return cosine_ * v + sine_ * cross(axis_, v) + ((1.0 - cosine_) * dot(axis_, v)) * axis_;
  }

  SectionBasis operator()(const SectionBasis& basis) const {
    return {(*this)(basis.p), (*this)(basis.q)};
  }

 private:
  Vector3 axis_;
  double cosine_;
  double sine_;
};

Vector3 unit_axis(const Vector3& axis) {
  if (!std::isfinite(norm(axis)) || axis == Vector3{}) {
    throw InvalidRequest("the axis of a rotation must be a direction: not 0,0,0 and finite");
  }
  return Plane::from_normal(axis, {}).normal();
}

Vector3 default_normal(const Vector3& axis) {
  const Vector3 z{0.0, 0.0, 1.0};
  const Vector3 perpendicular = z - dot(z, axis) * axis;
  return norm(perpendicular) > kAlongAxis ? perpendicular : Vector3{0.0, 1.0, 0.0};
}

struct Extent {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
};

Extent extent_along(const Plane& plane, const Cuboid& cuboid) {
  const Vector3 far = cuboid.extent();
  Extent extent;
  for (const double x : {0.0, far.x}) {
    for (const double y : {0.0, far.y}) {
      for (const double z : {0.0, far.z}) {
        const double distance = plane.signed_distance({x, y, z});
        extent.least = std::min(extent.least, distance);
        extent.most = std::max(extent.most, distance);
      }
    }
  }
  return extent;
}

std::string value_text(const Series& series, std::size_t index) {
  const double value = series.frames.at(index).value;
  const bool zero = std::abs(value) < 0.5 * std::pow(10.0, -series.decimals);  // never "-0"
  std::ostringstream text;
  text << std::showpos << std::internal << std::fixed << std::setfill('0')
       << std::setprecision(series.decimals)
       << std::setw(series.integer_digits + series.decimals + 2) << (zero ? 0.0 : value);
  return text.str();
}

}  // namespace

Series rotation_series(const Rotation& rotation, BasisKind kind, const Cuboid& cuboid) {
  const Vector3 axis = unit_axis(rotation.axis);
  const Vector3 through = rotation.through.value_or(0.5 * cuboid.extent());
  const Plane at_zero = Plane::from_normal(rotation.normal.value_or(default_normal(axis)), through);
  const std::vector<double> values = values_between(rotation.from, rotation.to, rotation.step);

  Series series = empty_series("deg", values);
  const auto plane_at = [&](double degrees) {
    return Plane::from_normal(Turn(axis, degrees)(at_zero.normal()), through);
  };
  const SectionBasis first = section_basis(kind, plane_at(values.front()));
  for (const double value : values) {
    series.frames.push_back(
        {value, plane_at(value), Turn(axis, value - values.front())(first), through});
  }
  return series;
}

Series translation_series(const Translation& translation, BasisKind kind, const Cuboid& cuboid) {
  const Vector3 through = translation.through.value_or(Vector3{});
  const Plane at_zero = Plane::from_normal(translation.normal, through);
  const Extent extent = extent_along(at_zero, cuboid);
  const std::vector<double> values =
      values_between(translation.from.value_or(extent.least), translation.to.value_or(extent.most),
                     translation.step);

  Series series = empty_series("um", values);
  const SectionBasis basis = section_basis(kind, at_zero);
  for (const double value : values) {
    const Vector3 moved = through + value * at_zero.normal();
    series.frames.push_back({value, Plane::from_normal(at_zero.normal(), moved), basis, moved});
  }
  return series;
}

std::string frame_label(const Series& series, std::size_t index) {
  return value_text(series, index) + ' ' + series.unit;
}

std::string frame_file_name(const Series& series, std::size_t index, const std::string& extension) {
  const std::size_t digits =
      std::max<std::size_t>(3, std::to_string(series.frames.size() - 1).size());
  const std::string number = std::to_string(index);
  return std::string(digits - std::min(digits, number.size()), '0') + number + '_' +
         value_text(series, index) + series.unit + extension;
}

}  // namespace biotomy::reconstruct
