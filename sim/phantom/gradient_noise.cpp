#include "sim/phantom/gradient_noise.hpp"

#include <array>
#include <limits>

namespace biotomy::sim {

namespace {

/// Far outside every phantom, so that the first point asked for always fills the cache.
constexpr std::int32_t kNoCell = std::numeric_limits<std::int32_t>::min();

/// Bijective mixing of 32 bits; the constants are "lowbias32" of C. Wellons' hash prospector.
std::uint32_t mix(std::uint32_t h) {
  h ^= h >> 16U;
  h *= 0x7feb352dU;
  h ^= h >> 15U;
  h *= 0x846ca68bU;
  h ^= h >> 16U;
  return h;
}

/// Perlin's fifth-degree fade: first and second derivatives vanish at 0 and 1.
float fade(float t) {
  return t * t * t * (t * (t * 6.0F - 15.0F) + 10.0F);
}

/// std::floor without the call that it costs on a processor of the lowest common kind.
std::int32_t floor_of(double x) {
  const auto whole = static_cast<std::int32_t>(x);
  return x < whole ? whole - 1 : whole;
}

struct Gradient {
  float x, y, z;
};

/// The twelve edge midpoints of a cube, four of them twice, as Perlin has them.
constexpr std::array<Gradient, 16> kGradients{{{1, 1, 0},
                                               {-1, 1, 0},
                                               {1, -1, 0},
                                               {-1, -1, 0},
                                               {1, 0, 1},
                                               {-1, 0, 1},
                                               {1, 0, -1},
                                               {-1, 0, -1},
                                               {0, 1, 1},
                                               {0, -1, 1},
                                               {0, 1, -1},
                                               {0, -1, -1},
                                               {1, 1, 0},
                                               {-1, 1, 0},
                                               {0, -1, 1},
                                               {0, -1, -1}}};

const Gradient& gradient(std::uint32_t seed, std::int32_t x, std::int32_t y, std::int32_t z) {
  const std::uint32_t h = mix(seed ^ (static_cast<std::uint32_t>(x) * 0x9e3779b1U) ^
                              mix((static_cast<std::uint32_t>(y) * 0x85ebca77U) ^
                                  (static_cast<std::uint32_t>(z) * 0xc2b2ae3dU)));
  return kGradients[h & 15U];
}

}  // namespace

std::uint32_t mixed_bits(std::uint64_t seed, std::uint64_t index) {
  const auto low = static_cast<std::uint32_t>(seed);
  const auto high = static_cast<std::uint32_t>(seed >> 32U);
  const auto index_low = static_cast<std::uint32_t>(index);
  const auto index_high = static_cast<std::uint32_t>(index >> 32U);
  return mix(mix(mix(mix(low) ^ high) + index_low * 0x9e3779b1U) ^ index_high);
}

float mixed_fraction(std::uint64_t seed, std::uint64_t index) {
  return static_cast<float>(mixed_bits(seed, index) >> 8U) * 0x1p-24F;
}

GradientNoise::GradientNoise(std::uint64_t seed, double cell_x_um, double cell_y_um,
                             double cell_z_um)
    : seed_(mixed_bits(seed, 0)),
      scale_x_(1.0 / cell_x_um),
      scale_y_(1.0 / cell_y_um),
      scale_z_(1.0 / cell_z_um) {}

GradientNoise::Line::Line(const GradientNoise& noise, double y_um, double z_um)
    : seed_(noise.seed_), scale_x_(noise.scale_x_), cell_x_(kNoCell) {
  const double y = y_um * noise.scale_y_;
  const double z = z_um * noise.scale_z_;
  cell_y_ = floor_of(y);
  cell_z_ = floor_of(z);
  y_ = static_cast<float>(y - cell_y_);
  z_ = static_cast<float>(z - cell_z_);
  fade_y_ = fade(y_);
  fade_z_ = fade(z_);
}

GradientNoise::Line::Column GradientNoise::Line::column(std::int32_t x) const {
  Column sum;
  for (int corner = 0; corner < 4; ++corner) {
    const int along_y = corner & 1;
    const int along_z = corner >> 1;
    const Gradient& g = gradient(seed_, x, cell_y_ + along_y, cell_z_ + along_z);
    const float weight =
        (along_y != 0 ? fade_y_ : 1.0F - fade_y_) * (along_z != 0 ? fade_z_ : 1.0F - fade_z_);
    sum.offset += weight * (g.y * (y_ - static_cast<float>(along_y)) +
                            g.z * (z_ - static_cast<float>(along_z)));
    sum.slope += weight * g.x;
  }
  return sum;
}

float GradientNoise::Line::at(double x_um) {
  const double x = x_um * scale_x_;
  const std::int32_t cell = floor_of(x);
  if (cell != cell_x_) {
    left_ = cell_x_ != kNoCell && cell == cell_x_ + 1 ? right_ : column(cell);
    right_ = column(cell + 1);
    cell_x_ = cell;
  }
  const auto dx = static_cast<float>(x - cell);
  const float from_left = left_.offset + left_.slope * dx;
  const float from_right = right_.offset + right_.slope * (dx - 1.0F);
  return from_left + fade(dx) * (from_right - from_left);
}

}  // namespace biotomy::sim
