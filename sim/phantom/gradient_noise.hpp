#pragma once

#include <cmath>
#include <cstdint>

namespace biotomy::sim {

/// Mixes a seed and an index into 32 well-spread bits; the same on every machine.
std::uint32_t mixed_bits(std::uint64_t seed, std::uint64_t index);

/// The same as a number in [0, 1).
float mixed_fraction(std::uint64_t seed, std::uint64_t index);

/// A smooth wave of period 1 and amplitude 1, much like sin(2πt), made of products and sums alone
/// so that no two machines differ in it.
inline float wave(float t) {
  const auto whole = static_cast<float>(static_cast<std::int32_t>(t));
  const float x = 1.0F - 2.0F * (t - whole + (t < whole ? 1.0F : 0.0F));
  const float parabola = 4.0F * x * (1.0F - std::fabs(x));
  return parabola + 0.225F * (parabola * std::fabs(parabola) - parabola);
}

/// Gradient noise in three dimensions (K. Perlin, "Improving Noise", SIGGRAPH 2002) with a hash in
/// place of the permutation table, hence without a period. Values lie in about [-1, 1], are 0 on
/// the lattice, twice differentiable, and hold nothing much finer than a cell. A pure function of
/// the seed and the point.
class GradientNoise {
 public:
  /// Cells may be longer along one axis than along another: that draws fibres.
  GradientNoise(std::uint64_t seed, double cell_x_um, double cell_y_um, double cell_z_um);
  GradientNoise(std::uint64_t seed, double cell_um)
      : GradientNoise(seed, cell_um, cell_um, cell_um) {}

  /// The noise along one line of constant y and z. It keeps the two lattice columns around the last
  /// x, which makes neighbouring points several times cheaper; the value does not depend on what
  /// was asked before.
  class Line {
   public:
    Line(const GradientNoise& noise, double y_um, double z_um);
    float at(double x_um);

   private:
    /// What one lattice column adds at a distance dx from it: offset + slope · dx.
    struct Column {
      float offset = 0;
      float slope = 0;
    };
    Column column(std::int32_t x) const;

    std::uint32_t seed_;
    double scale_x_;
    std::int32_t cell_y_ = 0;
    std::int32_t cell_z_ = 0;
    float y_ = 0;  ///< place in the cell, 0..1
    float z_ = 0;
    float fade_y_ = 0;
    float fade_z_ = 0;
    std::int32_t cell_x_ = 0;
    Column left_;
    Column right_;
  };

  Line line(double y_um, double z_um) const { return {*this, y_um, z_um}; }
  float at(double x_um, double y_um, double z_um) const { return line(y_um, z_um).at(x_um); }

 private:
  std::uint32_t seed_;
  double scale_x_;  ///< cells a micrometre
  double scale_y_;
  double scale_z_;
};

}  // namespace biotomy::sim
