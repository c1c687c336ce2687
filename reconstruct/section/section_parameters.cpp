#include "reconstruct/section/section_parameters.hpp"

#include <cmath>

#include "reconstruct/errors.hpp"
#include "reconstruct/excerpt.hpp"
#include "reconstruct/section/interpolation.hpp"

namespace biotomy::reconstruct {

SectionChoices section_choices(const std::string& prefix, const SectionParameters& parameters) {
  SectionChoices chosen{
      parse_unit(prefix + "unit", parameters.unit), basis_kind(parameters.basis), {}};
  chosen.style.interpolation = interpolation(parameters.interpolation);
  chosen.style.background = parse_colour(prefix + "background", parameters.background);
  return chosen;
}

SectionStyle section_style(const std::string& prefix, const SectionChoices& choices,
                           const SectionParameters& parameters, const Vector3& spacing) {
  SectionStyle style = choices.style;
  style.theta = parse_theta(prefix + "theta", parameters.theta, choices.unit, spacing);
  if (!parameters.pixel.empty()) {
    const double length = parse_number(prefix + "pixel", parameters.pixel);
    if (length <= 0.0) {
      throw InvalidRequest(prefix + "pixel '" + excerpt(parameters.pixel) +
                           "': give a size above 0");
    }
    style.pixel = length_in_micrometres(length, choices.unit, spacing);
  }
  return style;
}

int parse_quality(const std::string& name, const std::string& text) {
  const double quality = parse_number(name, text);
  if (quality < 1.0 || quality > 100.0 || quality != std::floor(quality)) {
    throw InvalidRequest(name + " '" + excerpt(text) + "': give a whole number from 1 to 100");
  }
  return static_cast<int>(quality);
}

}  // namespace biotomy::reconstruct
