#include "reconstruct/section/parameter_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr double kMicrometresPerMillimetre = 1000.0;
constexpr double kMostColour = 255.0;

[[noreturn]] void refuse(const std::string& name, const std::string& text,
                         const std::string& wanted) {
  throw InvalidRequest(name + " '" + excerpt(text) + "': give " + wanted);
}

std::string_view without_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  const auto last = text.find_last_not_of(" \t");
  return first == std::string_view::npos ? std::string_view{}
                                         : text.substr(first, last - first + 1);
}

std::optional<double> number(std::string_view text) {
  std::string_view digits = without_blanks(text);
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') {
    digits.remove_prefix(1);
  }
  double value = 0.0;
  const char* const end = digits.data() + digits.size();
  const auto [stopped, error] = std::from_chars(digits.data(), end, value);
  if (error != std::errc{} || stopped != end || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<std::array<double, 3>> three_numbers(std::string_view text) {
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto comma = text.find(',');
    if ((comma == std::string_view::npos) != (i == 2)) {
      return std::nullopt;
    }
    const std::optional<double> value = number(text.substr(0, comma));
    if (!value) {
      return std::nullopt;
    }
    values[i] = *value;
    text.remove_prefix(i == 2 ? text.size() : comma + 1);
  }
  return values;
}

std::array<Vector3, 3> parse_points(const std::string& name, const std::string& text) {
  const std::string wanted = "three points, \"x,y,z x,y,z x,y,z\"";
  std::istringstream words(text);
  std::vector<Vector3> points;
  for (std::string word; words >> word;) {
    const auto values = three_numbers(word);
    if (!values || points.size() == 3) {
      refuse(name, text, wanted);
    }
    points.push_back({(*values)[0], (*values)[1], (*values)[2]});
  }
  if (points.size() != 3) {
    refuse(name, text, wanted);
  }
  return {points[0], points[1], points[2]};
}

}  // namespace

double parse_number(const std::string& name, const std::string& text) {
  const std::optional<double> value = number(text);
  if (!value) {
    refuse(name, text, "one number");
  }
  return *value;
}

Vector3 parse_vector(const std::string& name, const std::string& text) {
  const auto values = three_numbers(text);
  if (!values) {
    refuse(name, text, "three numbers, x,y,z");
  }
  return {(*values)[0], (*values)[1], (*values)[2]};
}

Colour parse_colour(const std::string& name, const std::string& text) {
  const auto values = three_numbers(text);
  Colour colour{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = values ? (*values)[i] : -1.0;
    if (value < 0.0 || value > kMostColour || value != std::floor(value)) {
      refuse(name, text, "three whole numbers from 0 to 255, R,G,B");
    }
    colour[i] = static_cast<std::uint8_t>(value);
  }
  return colour;
}

LengthUnit parse_unit(const std::string& name, const std::string& text) {
  if (text == "um") {
    return LengthUnit::micrometres;
  }
  if (text == "mm") {
    return LengthUnit::millimetres;
  }
  if (text == "voxel") {
    return LengthUnit::voxels;
  }
  refuse(name, text, "um, mm or voxel");
}

Vector3 position_in_micrometres(const Vector3& position, LengthUnit unit, const Vector3& spacing) {
  switch (unit) {
    case LengthUnit::micrometres:
      return position;
    case LengthUnit::millimetres:
      return kMicrometresPerMillimetre * position;
    case LengthUnit::voxels:
      break;
  }
  return {position.x * spacing.x, position.y * spacing.y, position.z * spacing.z};
}

double length_in_micrometres(double length, LengthUnit unit, const Vector3& spacing) {
  switch (unit) {
    case LengthUnit::micrometres:
      return length;
    case LengthUnit::millimetres:
      return kMicrometresPerMillimetre * length;
    case LengthUnit::voxels:
      break;
  }
  return length * std::min({spacing.x, spacing.y, spacing.z});
}

Plane parse_plane(const std::string& prefix, const PlaneText& text, LengthUnit unit,
                  const Vector3& spacing) {
  const bool by_points = text.points && !text.normal && !text.through;
  const bool by_normal = !text.points && text.normal && text.through;
  if (by_points) {
    const std::array<Vector3, 3> points = parse_points(prefix + "points", *text.points);
    return Plane::through_points(position_in_micrometres(points[0], unit, spacing),
                                 position_in_micrometres(points[1], unit, spacing),
                                 position_in_micrometres(points[2], unit, spacing));
  }
  if (by_normal) {
    const Vector3 normal = parse_vector(prefix + "normal", *text.normal);
    const Vector3 through = parse_vector(prefix + "through", *text.through);
    return Plane::from_normal(normal, position_in_micrometres(through, unit, spacing));
  }
  throw InvalidRequest("which plane? give either " + prefix + "points, or " + prefix +
                       "normal and " + prefix + "through");
}

}  // namespace biotomy::reconstruct
