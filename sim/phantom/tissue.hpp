#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace biotomy::sim {

/// Colour as the camera would see it at its nominal exposure: 0..255 levels, linear in light.
struct Colour {
  float r = 0;
  float g = 0;
  float b = 0;

  friend bool operator==(const Colour&, const Colour&) = default;
};

constexpr Colour operator*(float factor, const Colour& c) {
  return {factor * c.r, factor * c.g, factor * c.b};
}

constexpr Colour mixed(const Colour& a, const Colour& b, float share_of_b) {
  return {a.r + share_of_b * (b.r - a.r), a.g + share_of_b * (b.g - a.g),
          a.b + share_of_b * (b.b - a.b)};
}

/// The brightest textures would leave the levels of a photograph.
constexpr Colour within_levels(const Colour& c) {
  return {std::clamp(c.r, 0.0F, 255.0F), std::clamp(c.g, 0.0F, 255.0F),
          std::clamp(c.b, 0.0F, 255.0F)};
}

/// What a point of the phantom is made of.
enum class Tissue {
  casting,
  fat,
  fascia,
  muscle,
  tendon,
  synovia,
  meniscus,
  cartilage,
  cortical_bone,
  trabecula,
  red_marrow,
  yellow_marrow,
  artery_wall,
  artery_blood,
  vein_blood,
  nerve,
};

/// The middle colour of each tissue, before its texture.
inline constexpr std::array<Colour, 16> kTissueColours{{
    {52, 118, 78},    // casting: green, far from every tissue, so that it can be told apart
    {222, 195, 125},  // fat
    {214, 198, 178},  // fascia
    {138, 38, 36},    // muscle
    {218, 208, 190},  // tendon
    {176, 116, 92},   // synovia
    {198, 190, 172},  // meniscus
    {196, 212, 222},  // cartilage
    {228, 212, 178},  // cortical_bone
    {222, 194, 152},  // trabecula
    {146, 44, 36},    // red_marrow
    {208, 146, 76},   // yellow_marrow
    {206, 150, 138},  // artery_wall
    {150, 18, 22},    // artery_blood
    {74, 22, 46},     // vein_blood
    {226, 214, 160},  // nerve
}};

constexpr const Colour& colour_of(Tissue tissue) {
  return kTissueColours[static_cast<std::size_t>(tissue)];
}

}  // namespace biotomy::sim
