#pragma once

#include <cstddef>
#include <string>

#include "reconstruct/bricks/volume_bricks.hpp"
#include "reconstruct/geometry/vector3.hpp"
#include "reconstruct/section/section.hpp"
#include "reconstruct/section/section_parameters.hpp"

namespace CLI {
class App;
}

namespace biotomy::tools {

/// The options that all commands that cut sections have, as they were typed.
struct SectionOptions : reconstruct::SectionParameters {
  std::string cache_mb = "512";
  bool tolerate_missing = false;
};

/// What those options mean, as far as it does not depend on the sample.
struct SectionChoices : reconstruct::SectionChoices {
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
