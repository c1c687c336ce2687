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
#include "reconstruct/section/nearest_word.hpp"

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

template <std::size_t N>
std::optional<std::array<double, N>> numbers(std::string_view text) {
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    const auto comma = text.find(',');
    if ((comma == std::string_view::npos) != (i == N - 1)) {
      return std::nullopt;
    }
    const std::optional<double> value = number(text.substr(0, comma));
    if (!value) {
      return std::nullopt;
    }
    values[i] = *value;
    text.remove_prefix(i == N - 1 ? text.size() : comma + 1);
  }
  return values;
}

std::array<Vector3, 3> parse_points(const std::string& name, const std::string& text) {
  const std::string wanted = "three points, \"x,y,z x,y,z x,y,z\"";
  std::istringstream words(text);
  std::vector<Vector3> points;
  for (std::string word; words >> word;) {
    const auto values = numbers<3>(word);
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

ThetaChoice parse_edge(const std::string& name, const std::string& text,
                       std::string_view edge_text) {
  int edge = -1;
  const char* const end = edge_text.data() + edge_text.size();
  const auto [stopped, error] = std::from_chars(edge_text.data(), end, edge);
  if (error != std::errc{} || stopped != end || edge < 0) {
    refuse(name, text,
           "edge:I with the whole number I of an edge of the section: edge:0 is the first");
  }
  return theta::InscribedAtEdge{edge};
}

ThetaChoice parse_custom(const std::string& name, const std::string& text,
                         std::string_view custom_text, LengthUnit unit, const Vector3& spacing) {
  const auto values = numbers<6>(custom_text);
  if (!values) {
    refuse(name, text, "custom:X,Y,Z,W,H,ANGLE, six numbers");
  }
  const auto& [x, y, z, width, height, angle] = *values;
  if (width <= 0.0 || height <= 0.0) {
    refuse(name, text, "a width and a height above 0");
  }
  return theta::Custom{position_in_micrometres({x, y, z}, unit, spacing),
                       length_in_micrometres(width, unit, spacing),
                       length_in_micrometres(height, unit, spacing), angle};
}

[[noreturn]] void refuse_theta(const std::string& name, const std::string& text,
                               std::string_view word) {
  constexpr std::array<std::string_view, 5> kWords{"bounding", "inscribed", "inscribed-any", "edge",
                                                   "custom"};
  const std::string_view nearest = nearest_word(word, kWords);
  const std::string question = nearest.empty() ? "" : "did you mean " + std::string(nearest) + "? ";
  throw InvalidRequest(name + " '" + excerpt(text) + "': " + question +
                       "give bounding, inscribed, inscribed-any, edge:I or "
                       "custom:X,Y,Z,W,H,ANGLE");
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
  const auto values = numbers<3>(text);
  if (!values) {
    refuse(name, text, "three numbers, x,y,z");
  }
  return {(*values)[0], (*values)[1], (*values)[2]};
}

Colour parse_colour(const std::string& name, const std::string& text) {
  const auto values = numbers<3>(text);
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

ThetaChoice parse_theta(const std::string& name, const std::string& text, LengthUnit unit,
                        const Vector3& spacing) {
  const std::string_view whole = without_blanks(text);
  const auto colon = whole.find(':');
  const bool is_alone = colon == std::string_view::npos;
  const std::string_view word = whole.substr(0, colon);
  const std::string_view rest = is_alone ? std::string_view{} : whole.substr(colon + 1);
  if (word == "edge") {
    return parse_edge(name, text, rest);
  }
  if (word == "custom") {
    return parse_custom(name, text, rest, unit, spacing);
  }
  if (is_alone) {
    if (word == "bounding") {
      return theta::Bounding{};
    }
    if (word == "inscribed") {
      return theta::Inscribed{};
    }
    if (word == "inscribed-any") {
      return theta::InscribedAny{};
    }
  }
  refuse_theta(name, text, word);
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
