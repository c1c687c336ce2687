#pragma once

#include <cstddef>
#include <string>

#include "reconstruct/bricks/volume_bricks.hpp"
#include "reconstruct/geometry/section_basis.hpp"
#include "reconstruct/geometry/vector3.hpp"
#include "reconstruct/section/parameter_text.hpp"
#include "reconstruct/section/section.hpp"

namespace CLI {
class App;
}

namespace biotomy::tools {

/// The options that all commands that cut sections have, as they were typed.
struct SectionOptions {
  std::string unit = "um";
  std::string basis = "layer";
  std::string theta = "bounding";
  std::string interpolation = "linear";
  std::string pixel;  ///< empty: the least spacing
  std::string background;
  std::string cache_mb = "512";
  bool tolerate_missing = false;
};

/// What those options mean, as far as it does not depend on the sample.
struct SectionChoices {
  reconstruct::LengthUnit unit{};
  reconstruct::BasisKind basis{};
  reconstruct::SectionStyle style;
  std::size_t cache_bytes = 0;
  reconstruct::DamagePolicy damage;
};

/// `options.background` is the default that help shows.
void add_section_options(CLI::App& command, SectionOptions& options);

/// Throws InvalidRequest that names the option. The rectangle and the pixel size need
/// `style_for`.
SectionChoices choices(const SectionOptions& options);

/// The style with the rectangle and the pixel size in a sample of this spacing.
reconstruct::SectionStyle style_for(const SectionChoices& choices, const SectionOptions& options,
                                    const reconstruct::Vector3& spacing);

/// One line on stderr, when there is any.
void warn_of(const reconstruct::Damage& damage);

}  // namespace biotomy::tools
