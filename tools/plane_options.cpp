#include "tools/plane_options.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "reconstruct/errors.hpp"
#include "reconstruct/section/recorded_plane.hpp"

namespace biotomy::tools {
namespace {

using reconstruct::Cuboid;
using reconstruct::InvalidRequest;
using reconstruct::Plane;
using reconstruct::Vector3;

constexpr const char* kPoints = "--points";

bool may_be_a_point(const std::string& word) {
  return word.find(',') != std::string::npos &&
         word.find_first_not_of("0123456789+-.,eE ") == std::string::npos;
}

/// Cosine and sine, of right angles exactly.
std::pair<double, double> direction(double degrees) {
  const double radians = degrees * std::numbers::pi / 180.0;
  const double cosine = std::cos(radians);
  const double sine = std::sin(radians);
  if (std::fmod(degrees, 90.0) == 0.0) return {std::round(cosine), std::round(sine)};
  return {cosine, sine};
}

/// As the explorer's page rounds it, so that the same angles make the same picture.
double rounded(double component) {
  constexpr double kSteps = 1e6;
  return std::round(component * kSteps) / kSteps + 0.0;  // no negative zero
}

Vector3 normal_of(const PlaneOptions& options) {
  const double tilt = reconstruct::parse_number("--tilt", *options.tilt);
  const double azimuth = reconstruct::parse_number("--azimuth", options.azimuth.value_or("0"));
  if (tilt < 0.0 || tilt > 90.0) {
    throw InvalidRequest("--tilt '" + *options.tilt + "': give 0 to 90 degrees");
  }
  if (azimuth < -180.0 || azimuth > 180.0) {
    throw InvalidRequest("--azimuth '" + *options.azimuth + "': give -180 to 180 degrees");
  }
  const auto [down, across] = direction(tilt);
  const auto [x, y] = direction(azimuth);
  return {rounded(across * x), rounded(across * y), rounded(down)};
}

/// Of a point in the layer, micrometres.
double depth_of_layer(const std::string& text, const Cuboid& cuboid) {
  const double layer = reconstruct::parse_number("--layer", text);
  if (layer < 1.0 || layer != std::floor(layer)) {
    throw InvalidRequest("--layer '" + text + "': give a whole number from 1");
  }
  if (layer > static_cast<double>(cuboid.size.z)) {
    throw reconstruct::SampleError("--layer '" + text + "': the sample has layers 1 to " +
                                   std::to_string(cuboid.size.z));
  }
  return (layer - 1.0) * cuboid.spacing.z;
}

}  // namespace

void add_plane_options(CLI::App& command, PlaneOptions& options) {
  command.allow_extras();
  command.add_option(kPoints, options.points, "Three points of the plane, \"x,y,z x,y,z x,y,z\"");
  command.add_option("--normal", options.normal,
                     "A normal of the plane, a,b,c: a direction in space, whatever the unit");
  command.add_option("--through", options.through, "A point of the plane, x,y,z");
  command.add_option("--layer", options.layer, "Instead: along this layer, counted from 1");
  command.add_option("--tilt", options.tilt,
                     "Instead: degrees between the normal and z, 0 along the layers, 90 upright; "
                     "through the sample's middle without --through");
  command.add_option("--azimuth", options.azimuth,
                     "With --tilt: degrees of the normal about z, from x towards y; 0");
  command.add_option("--plane-of", options.earlier_section,
                     "Instead: the plane of an earlier section; its .json, .png or .tif");
}

// An option of up to three arguments would take the sample's name for one of them where that comes
// after it.
void take_unquoted_points(CLI::App& command) {
  const std::vector<std::string> unknown = command.remaining();
  if (unknown.empty()) {
    return;
  }
  std::string words;
  for (const std::string& word : unknown) {
    words += ' ' + word;
  }
  CLI::Option* points = command.get_option(kPoints);
  const bool with_points = points->count() > 0;
  if (with_points && std::all_of(unknown.begin(), unknown.end(), may_be_a_point)) {
    const std::string joined = points->results().front() + words;
    points->clear();
    points->add_result(joined);
    points->run_callback();
    return;
  }
  const bool torn = with_points && std::any_of(unknown.begin(), unknown.end(), may_be_a_point);
  throw InvalidRequest(
      "The following arguments were not expected:" + words +
      (torn ? "; put the three points into quotes: --points \"x,y,z x,y,z x,y,z\"" : ""));
}

Plane plane_of(const PlaneOptions& options, reconstruct::LengthUnit unit, const Cuboid& cuboid) {
  const bool by_points_or_normal = options.points || options.normal;
  const int ways = static_cast<int>(by_points_or_normal) +
                   static_cast<int>(options.layer.has_value()) +
                   static_cast<int>(options.tilt.has_value()) +
                   static_cast<int>(options.earlier_section.has_value());
  const bool takes_point = by_points_or_normal || options.tilt;
  if (ways != 1 || (options.azimuth && !options.tilt) || (options.through && !takes_point)) {
    throw InvalidRequest(
        "which plane? give --points, or --normal with --through, or --layer, or --tilt with or "
        "without --azimuth and --through, or --plane-of");
  }
  if (options.earlier_section) {
    return reconstruct::recorded_plane(*options.earlier_section);
  }
  if (by_points_or_normal) {
    return reconstruct::parse_plane("--", options, unit, cuboid.spacing);
  }
  if (options.layer) {
    return Plane::from_normal({0.0, 0.0, 1.0}, {0.0, 0.0, depth_of_layer(*options.layer, cuboid)});
  }
  const Vector3 point =
      options.through
          ? reconstruct::position_in_micrometres(
                reconstruct::parse_vector("--through", *options.through), unit, cuboid.spacing)
          : 0.5 * cuboid.extent();
  return Plane::from_normal(normal_of(options), point);
}

}  // namespace biotomy::tools
