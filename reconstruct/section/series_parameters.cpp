#include "reconstruct/section/series_parameters.hpp"

#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"
#include "reconstruct/section/section_record.hpp"

namespace biotomy::reconstruct {
namespace {

/// What the parameters' texts need to be read.
struct Reading {
  const std::string& prefix;
  LengthUnit unit;
  const Vector3& spacing;

  Vector3 axis(const std::string& text) const {
    if (text == "x") return {1.0, 0.0, 0.0};
    if (text == "y") return {0.0, 1.0, 0.0};
    if (text == "z") return {0.0, 0.0, 1.0};
    if (text.find(',') == std::string::npos) {
      throw InvalidRequest(prefix + "axis '" + excerpt(text) +
                           "': give x, y, z or a direction a,b,c");
    }
    return parse_vector(prefix + "axis", text);
  }

  std::optional<Vector3> through(const std::optional<std::string>& text) const {
    if (!text) return std::nullopt;
    return position_in_micrometres(parse_vector(prefix + "through", *text), unit, spacing);
  }

  std::optional<double> length(const std::string& name,
                               const std::optional<std::string>& text) const {
    if (!text) return std::nullopt;
    return length_in_micrometres(parse_number(prefix + name, *text), unit, spacing);
  }
};

}  // namespace

Series parse_rotation(const std::string& prefix, const SeriesParameters& parameters,
                      LengthUnit unit, BasisKind basis, const Cuboid& cuboid) {
  const Reading reading{prefix, unit, cuboid.spacing};
  Rotation asked;
  asked.axis = reading.axis(parameters.axis);
  asked.through = reading.through(parameters.through);
  if (parameters.normal) asked.normal = parse_vector(prefix + "normal", *parameters.normal);
  asked.from = parse_number(prefix + "from", parameters.from.value_or("0"));
  asked.to = parse_number(prefix + "to", parameters.to.value_or("180"));
  asked.step = parse_number(prefix + "step", parameters.step);
  return rotation_series(asked, basis, cuboid);
}

Series parse_translation(const std::string& prefix, const SeriesParameters& parameters,
                         LengthUnit unit, BasisKind basis, const Cuboid& cuboid) {
  const Reading reading{prefix, unit, cuboid.spacing};
  Translation asked;
  asked.normal = parse_vector(prefix + "normal", parameters.normal.value_or(""));
  asked.through = reading.through(parameters.through);
  asked.from = reading.length("from", parameters.from);
  asked.to = reading.length("to", parameters.to);
  asked.step = *reading.length("step", parameters.step);
  return translation_series(asked, basis, cuboid);
}

PictureNotes frame_notes(const SeriesFrames& frames, std::size_t index, const std::string& sample,
                         const Cuboid& cuboid, const SampleStatistics& statistics,
                         const nlohmann::ordered_json& parameters) {
  const std::optional<SectionOutline>& outline = frames.outline(index);
  const Plane& plane = frames.series().frames[index].plane;
  if (!outline) {
    return picture_notes(
        EmptyFrameRecord{sample, cuboid, plane, frames.pixel(), frames.frame_size(), parameters});
  }
  return picture_notes(SectionRecord{sample, cuboid, plane, *outline, frames.frame_size(),
                                     frames.first_pixel(index), statistics.levels, parameters});
}

}  // namespace biotomy::reconstruct
