#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "sim/phantom/anatomy.hpp"
#include "sim/phantom/gradient_noise.hpp"
#include "sim/phantom/tissue.hpp"

namespace biotomy::sim {

struct PhantomSettings {
  std::uint64_t seed = 1;
  double width_um = 10000;  ///< of the picture that shows it whole: casting material all round
  double height_um = 10000;
  double depth_um = 640;  ///< the anatomy changes markedly, not wildly, over it
  double detail_um = 35;  ///< the finest detail: edges this wide, no texture finer; 3 to 4 pixels

  // The specimen's rounded ends along z, beyond which is casting alone. By default it has none.
  double begins_um = -std::numeric_limits<double>::infinity();
  double ends_um = std::numeric_limits<double>::infinity();
  double end_um = 300;  ///< from an end to where the specimen is as wide as it gets
};

/// A joint in green casting material, defined by formulas at every point: no grid, no stored
/// volume, so that a face at any depth and any section can be worked out exactly and compared with
/// what went through the rig. Nothing but sums, products, square roots and integer hashes goes into
/// it, so that it is the same on every machine.
///
/// Coordinates are the sample's: micrometres from the upper left corner of the first face, x right,
/// y down, z into the block. Outside the given size the formulas simply continue. A pure function
/// of settings and point; any number of threads may ask at once.
class Phantom {
 public:
  explicit Phantom(const PhantomSettings& settings);

  Colour colour_at(double x_um, double y_um, double z_um) const;
  Tissue tissue_at(double x_um, double y_um, double z_um) const;

  /// The colours at x, x + step, x + 2·step …: bit for bit those of colour_at, about twice as fast.
  void paint_row(double x_um, double step_um, double y_um, double z_um,
                 std::span<Colour> row) const;

  const PhantomSettings& settings() const { return settings_; }

 private:
  class Brush;

  PhantomSettings settings_;
  double half_width_um_;
  double half_height_um_;
  double anatomy_depth_um_;
  float softness_;     ///< the width of an edge in the anatomy's unit
  float wall_edge_;    ///< the softness of a trabecula's edge, in the noise's unit
  float bundle_edge_;  ///< likewise of the lines between bundles of fibres

  Anatomy anatomy_;
  GradientNoise clouds_;       ///< broad differences within a tissue
  GradientNoise grain_;        ///< the finest mottling, in everything
  GradientNoise lobules_;      ///< of fat
  GradientNoise fibres_;       ///< of muscle, long in y
  GradientNoise fine_fibres_;  ///< of muscle and tendon
  GradientNoise spongiosa_;
  GradientNoise fine_spongiosa_;
};

}  // namespace biotomy::sim
