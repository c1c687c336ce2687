#include "acquisition/viewer/section_query.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

#include "acquisition/viewer/command_line.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"
#include "reconstruct/section/nearest_word.hpp"

namespace biotomy::acquisition {
namespace {

using reconstruct::InvalidRequest;
using reconstruct::PictureFormat;
using reconstruct::SectionParameters;

constexpr int kLongestFit = 16384;
// A rectangle of n − ε pixels has n columns: far enough from n that rounding makes no difference.
constexpr double kShortOfAPixel = 0.01;
constexpr int kDigitsOfPixel = 5;

[[noreturn]] void refuse_fit(const std::string& text) {
  throw InvalidRequest("fit '" + reconstruct::excerpt(text) +
                       "': give WxH in pixels, each from 1 to " + std::to_string(kLongestFit));
}

cv::Size parse_fit(const std::string& text) {
  cv::Size size;
  const char* const end = text.data() + text.size();
  const auto [cross, width_error] = std::from_chars(text.data(), end, size.width);
  if (width_error != std::errc() || cross == end || *cross != 'x') refuse_fit(text);
  const auto [stopped, height_error] = std::from_chars(cross + 1, end, size.height);
  if (height_error != std::errc() || stopped != end || size.width < 1 || size.height < 1 ||
      size.width > kLongestFit || size.height > kLongestFit) {
    refuse_fit(text);
  }
  return size;
}

/// The next number above with few digits.
std::string rounded_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) + 1 - kDigitsOfPixel);
  std::array<char, 64> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), std::ceil(value / unit) * unit,
                    std::chars_format::general, kDigitsOfPixel);
  return {text.data(), end};
}

/// In the order in which the command has them.
std::vector<CommandOption> options_of(const SectionQuery& query) {
  const SectionParameters& asked = query.parameters;
  const SectionParameters fallback;
  return {{"points", query.plane.points.value_or("")},
          {"normal", query.plane.normal.value_or("")},
          {"through", query.plane.through.value_or("")},
          {"unit", asked.unit, fallback.unit},
          {"basis", asked.basis, fallback.basis},
          {"theta", asked.theta, fallback.theta},
          {"interpolation", asked.interpolation, fallback.interpolation},
          {"pixel", asked.pixel},
          {"background", asked.background, fallback.background},
          {"quality", query.quality, SectionQuery{}.quality}};
}

}  // namespace

void refuse_unknown(const Query& query, std::span<const std::string_view> known) {
  for (const auto& [name, value] : query) {
    if (name == "v" || name == "generation" ||
        std::find(known.begin(), known.end(), name) != known.end()) {
      continue;
    }
    const std::string_view nearest = reconstruct::nearest_word(name, known);
    throw InvalidRequest("there is no parameter '" + reconstruct::excerpt(name) + "'" +
                         (nearest.empty() ? "" : ": did you mean " + std::string(nearest) + "?"));
  }
}

void take(const Query& query, const std::string& name, std::string& text) {
  if (const auto found = query.find(name); found != query.end()) text = found->second;
}

void take(const Query& query, const std::string& name, std::optional<std::string>& text) {
  if (const auto found = query.find(name); found != query.end()) text = found->second;
}

SectionQuery style_query(const Query& query, const std::string& background) {
  SectionQuery asked;
  asked.parameters.background = background;
  take(query, "unit", asked.parameters.unit);
  take(query, "basis", asked.parameters.basis);
  take(query, "theta", asked.parameters.theta);
  take(query, "interpolation", asked.parameters.interpolation);
  take(query, "pixel", asked.parameters.pixel);
  take(query, "background", asked.parameters.background);
  take(query, "format", asked.format);
  take(query, "quality", asked.quality);
  format_of(asked.format);
  reconstruct::parse_quality("quality", asked.quality);
  std::optional<std::string> fit;
  take(query, "fit", fit);
  if (fit) asked.fit = parse_fit(*fit);
  return asked;
}

SectionQuery section_query(const Query& query) {
  static constexpr std::array<std::string_view, 12> kKnown = {
      "points",        "normal", "through",    "unit",   "basis",   "theta",
      "interpolation", "pixel",  "background", "format", "quality", "fit"};
  refuse_unknown(query, kKnown);
  SectionQuery asked = style_query(query, SectionParameters{}.background);
  take(query, "points", asked.plane.points);
  take(query, "normal", asked.plane.normal);
  take(query, "through", asked.plane.through);
  return asked;
}

reconstruct::SectionRequest section_request(const SectionQuery& query,
                                            const reconstruct::Cuboid& cuboid) {
  const reconstruct::SectionChoices chosen = reconstruct::section_choices("", query.parameters);
  const reconstruct::Plane plane =
      reconstruct::parse_plane("", query.plane, chosen.unit, cuboid.spacing);
  return {plane, reconstruct::section_basis(chosen.basis, plane),
          reconstruct::section_style("", chosen, query.parameters, cuboid.spacing)};
}

double pixel_to_fit(const reconstruct::ThetaRectangle& rectangle, const cv::Size& fit) {
  return std::max(rectangle.width / (fit.width - kShortOfAPixel),
                  rectangle.height / (fit.height - kShortOfAPixel));
}

SectionQuery with_pixel(const SectionQuery& query, double least,
                        const reconstruct::Vector3& spacing) {
  const reconstruct::LengthUnit unit = reconstruct::parse_unit("unit", query.parameters.unit);
  SectionQuery other = query;
  other.parameters.pixel =
      rounded_up(least / reconstruct::length_in_micrometres(1.0, unit, spacing));
  return other;
}

SectionQuery fitted(const SectionQuery& query, const reconstruct::Cuboid& cuboid, int bits) {
  if (!query.fit) return query;
  reconstruct::SectionRequest request = section_request(query, cuboid);
  request.style.max_bytes = std::numeric_limits<std::int64_t>::max();
  const reconstruct::PixelGrid grid = reconstruct::outline_section(cuboid, bits, request).grid;
  if (grid.columns <= query.fit->width && grid.rows <= query.fit->height) return query;
  return with_pixel(query, pixel_to_fit(grid.rectangle, *query.fit), cuboid.spacing);
}

PictureFormat format_of(const std::string& format) {
  if (format == "png") return PictureFormat::png;
  if (format == "jpeg" || format == "jpg") return PictureFormat::jpeg;
  if (format == "tiff" || format == "tif") return PictureFormat::tiff;
  throw InvalidRequest("format '" + reconstruct::excerpt(format) + "': there are png, jpeg, tiff");
}

std::string extension_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::png:
      return ".png";
    case PictureFormat::jpeg:
      return ".jpg";
    case PictureFormat::tiff:
      break;
  }
  return ".tif";
}

std::string content_type_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::png:
      return "image/png";
    case PictureFormat::jpeg:
      return "image/jpeg";
    case PictureFormat::tiff:
      break;
  }
  return "image/tiff";
}

std::string section_command(const SectionQuery& query, const std::filesystem::path& sample) {
  return command_line({"biotomy", "section", sample.string()}, options_of(query)) +
         " --output=section" + extension_of(format_of(query.format));
}

nlohmann::ordered_json section_command_parameters(const SectionQuery& query) {
  return command_parameters("section", options_of(query));
}

}  // namespace biotomy::acquisition
