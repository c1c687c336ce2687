#pragma once

#include <string>

#include "reconstruct/geometry/section_basis.hpp"
#include "reconstruct/geometry/vector3.hpp"
#include "reconstruct/section/parameter_text.hpp"
#include "reconstruct/section/section.hpp"

namespace biotomy::reconstruct {

/// The parameters that every way to ask for sections has, as people write them.
struct SectionParameters {
  std::string unit = "um";
  std::string basis = "layer";
  std::string theta = "bounding";
  std::string interpolation = "linear";
  std::string pixel = "";  ///< empty: the least spacing
  std::string background = "0,0,0";
};

/// What they mean, as far as it does not depend on the sample.
struct SectionChoices {
  LengthUnit unit{};
  BasisKind basis{};
  SectionStyle style;
};

/// `prefix` goes before the names in messages: "--" in the tool. Throws InvalidRequest that names
/// the parameter. The rectangle and the pixel size need `section_style`.
SectionChoices section_choices(const std::string& prefix, const SectionParameters& parameters);

/// The style with the rectangle and the pixel size in a sample of this spacing. Throws likewise.
SectionStyle section_style(const std::string& prefix, const SectionChoices& choices,
                           const SectionParameters& parameters, const Vector3& spacing);

/// Of a JPEG. Throws InvalidRequest that begins with `name` for anything but a whole number from 1
/// to 100.
int parse_quality(const std::string& name, const std::string& text);

}  // namespace biotomy::reconstruct
