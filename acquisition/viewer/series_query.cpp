#include "acquisition/viewer/series_query.hpp"

#include <vector>

#include "acquisition/viewer/command_line.hpp"
#include "acquisition/viewer/refusal.hpp"
#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"

namespace biotomy::acquisition {
namespace {

using reconstruct::Colour;
using reconstruct::SectionParameters;

constexpr const char* kRotate = "rotate";
constexpr const char* kTranslate = "translate";
constexpr const char* kRate = "25";
constexpr std::size_t kMostFrames = 10'000;

std::string series_background() {
  const Colour& colour = reconstruct::kGreyBlue;
  return std::to_string(colour[0]) + ',' + std::to_string(colour[1]) + ',' +
         std::to_string(colour[2]);
}

/// "png", "tif" or "jpg", as `biotomy series` has them.
std::string command_format(const SeriesQuery& query) {
  return extension_of(format_of(query.style.format)).substr(1);
}

/// In the order in which the command has them.
std::vector<CommandOption> options_of(const SeriesQuery& query) {
  const reconstruct::SeriesParameters& series = query.series;
  const SectionParameters& style = query.style.parameters;
  const SectionParameters fallback;
  std::vector<CommandOption> options;
  if (query.kind == kRotate) {
    options = {{"axis", series.axis},
               {"through", series.through.value_or("")},
               {"normal", series.normal.value_or("")}};
  } else {
    options = {{"normal", series.normal.value_or("")}, {"through", series.through.value_or("")}};
  }
  const std::vector<CommandOption> shared = {
      {"from", series.from.value_or("")},
      {"to", series.to.value_or("")},
      {"step", series.step},
      {"format", command_format(query), "png"},
      {"unit", style.unit, fallback.unit},
      {"basis", style.basis, fallback.basis},
      {"theta", style.theta, fallback.theta},
      {"interpolation", style.interpolation, fallback.interpolation},
      {"pixel", style.pixel},
      {"background", style.background, series_background()},
      {"quality", query.style.quality, SectionQuery{}.quality}};
  options.insert(options.end(), shared.begin(), shared.end());
  return options;
}

}  // namespace

SeriesQuery series_query(const Query& query, std::initializer_list<std::string_view> others) {
  std::vector<std::string_view> known = {
      "kind",  "axis",  "normal",        "through", "from",       "to",     "step",    "unit",
      "basis", "theta", "interpolation", "pixel",   "background", "format", "quality", "fit"};
  known.insert(known.end(), others.begin(), others.end());
  refuse_unknown(query, known);
  SeriesQuery asked;
  take(query, "kind", asked.kind);
  if (asked.kind != kRotate && asked.kind != kTranslate) {
    throw reconstruct::InvalidRequest("kind '" + reconstruct::excerpt(asked.kind) +
                                      "': there are rotate and translate");
  }
  if (asked.kind == kTranslate && query.contains("axis")) {
    throw reconstruct::InvalidRequest("axis: only a rotation has one");
  }
  take(query, "axis", asked.series.axis);
  take(query, "normal", asked.series.normal);
  take(query, "through", asked.series.through);
  take(query, "from", asked.series.from);
  take(query, "to", asked.series.to);
  take(query, "step", asked.series.step);
  asked.style = style_query(query, series_background());
  return asked;
}

reconstruct::Series series_of(const SeriesQuery& query, const reconstruct::Cuboid& cuboid) {
  const reconstruct::SectionChoices chosen =
      reconstruct::section_choices("", query.style.parameters);
  const auto parse =
      query.kind == kRotate ? &reconstruct::parse_rotation : &reconstruct::parse_translation;
  reconstruct::Series series = parse("", query.series, chosen.unit, chosen.basis, cuboid);
  if (series.frames.size() > kMostFrames) {
    throw Refusal(413, "the series has " + std::to_string(series.frames.size()) + " frames, and " +
                           std::to_string(kMostFrames) +
                           " are the most that are shown or exported: make its step larger, or "
                           "run biotomy series");
  }
  return series;
}

reconstruct::SectionStyle style_of(const SeriesQuery& query, const reconstruct::Cuboid& cuboid) {
  const SectionParameters& parameters = query.style.parameters;
  return reconstruct::section_style("", reconstruct::section_choices("", parameters), parameters,
                                    cuboid.spacing);
}

std::string series_command(const SeriesQuery& query, const std::filesystem::path& sample,
                           bool movie, const std::string& rate) {
  std::string line =
      command_line({"biotomy", "series", sample.string(), query.kind}, options_of(query));
  line += " --output=series";
  if (movie) {
    line += " --movie=series.mp4";
    if (!rate.empty() && rate != kRate) line += " --rate=" + shell_word(rate);
  }
  return line;
}

nlohmann::ordered_json series_command_parameters(const SeriesQuery& query) {
  return command_parameters(query.kind, options_of(query));
}

}  // namespace biotomy::acquisition
