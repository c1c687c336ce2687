#include "tools/section_options.hpp"

#include <iostream>

#include <CLI/CLI.hpp>

#include "reconstruct/errors.hpp"

namespace biotomy::tools {
namespace {

constexpr double kBytesPerMb = 1e6;
constexpr double kMostCacheMb = 1e6;

std::size_t cache_bytes(const std::string& text) {
  const double megabytes = reconstruct::parse_number("--cache-mb", text);
  if (megabytes < 0.0 || megabytes > kMostCacheMb) {
    throw reconstruct::InvalidRequest("--cache-mb '" + text + "': give 0 to 1000000");
  }
  return static_cast<std::size_t>(megabytes * kBytesPerMb);
}

}  // namespace

void add_section_options(CLI::App& command, SectionOptions& options) {
  command
      .add_option("--unit", options.unit,
                  "Of points and lengths: um, mm or voxel (a length: the least spacing)")
      ->capture_default_str();
  command.add_option("--basis", options.basis, "How the picture lies in the plane: layer or xz")
      ->capture_default_str();
  command
      .add_option("--theta", options.theta,
                  "The rectangle of the picture: bounding, inscribed, inscribed-any, edge:I or "
                  "custom:X,Y,Z,W,H,ANGLE")
      ->capture_default_str();
  command.add_option("--interpolation", options.interpolation, "nearest, linear or cubic")
      ->capture_default_str();
  command.add_option("--pixel", options.pixel, "Size of a pixel; the least spacing if none");
  command.add_option("--background", options.background, "Colour outside the sample, R,G,B")
      ->capture_default_str();
  command.add_option("--cache-mb", options.cache_mb, "Memory for decoded chunks, at most, MB")
      ->capture_default_str();
  command.add_flag("--tolerate-missing", options.tolerate_missing,
                   "What is damaged or missing becomes background, with a warning, not an error");
}

SectionChoices choices(const SectionOptions& options) {
  SectionChoices chosen{
      reconstruct::section_choices("--", options), cache_bytes(options.cache_mb), {}};
  chosen.damage = {options.tolerate_missing, chosen.style.background};
  return chosen;
}

reconstruct::SectionStyle style_for(const SectionChoices& choices, const SectionOptions& options,
                                    const reconstruct::Vector3& spacing) {
  return reconstruct::section_style("--", choices, options, spacing);
}

void warn_of(const reconstruct::Damage& damage) {
  if (damage.chunks == 0) {
    return;
  }
  std::cerr << "biotomy: " << damage.chunks
            << (damage.chunks == 1 ? " chunk cannot be read and is"
                                   : " chunks cannot be read and are")
            << " background; " << (damage.chunks == 1 ? "" : "the first: ") << damage.first << '\n';
}

}  // namespace biotomy::tools
