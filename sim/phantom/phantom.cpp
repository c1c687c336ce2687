#include "sim/phantom/phantom.hpp"

#include <algorithm>
#include <cmath>

#include "sim/phantom/signed_distance.hpp"

namespace biotomy::sim {

namespace {

/// How much of a point lies inside an outline whose edge is `softness` wide: 0 outside, 1 inside.
float coverage(float distance, float softness) {
  if (distance >= 0.5F * softness) {
    return 0.0F;
  }
  return 1.0F - smooth_step(-0.5F * softness, 0.5F * softness, distance);
}

/// Paint in layers, the last on top.
struct Paint {
  Colour colour;
  Tissue tissue = Tissue::casting;

  void lay(Tissue what, const Colour& with, float cover) {
    if (cover <= 0.0F) {
      return;
    }
    colour = mixed(colour, with, cover);
    if (cover >= 0.5F) {
      tissue = what;
    }
  }
};

/// By how much the outline of the specimen lies further in at this depth, in the anatomy's unit: an
/// ellipse from where it ends to where it is as wide as it gets.
float narrowing(const PhantomSettings& s, double z_um) {
  constexpr double kHalfSpecimen = 0.9;
  const double from_end = std::min(z_um - s.begins_um, s.ends_um - z_um) / s.end_um;
  const double away = 1.0 - std::clamp(from_end, 0.0, 1.0);
  return static_cast<float>(kHalfSpecimen * (1.0 - std::sqrt(1.0 - away * away)));
}

/// The row of a section through a noise, whose lattice is turned about x. Parallel to the lattice,
/// all of a section would lie equally far from the lattice's planes, where the noise is faintest,
/// and textures would grow finer and coarser with the depth, everywhere at once.
GradientNoise::Line row_of(const GradientNoise& noise, double y_um, double z_um) {
  constexpr double kCosine = 0.8;
  constexpr double kSine = 0.6;
  return noise.line(kCosine * y_um - kSine * z_um, kSine * y_um + kCosine * z_um);
}

Colour toned(Tissue tissue, float tone) {
  return (1.0F + tone) * colour_of(tissue);
}

}  // namespace

/// Paints the points of one row, in any order.
class Phantom::Brush {
 public:
  Brush(const Phantom& phantom, double y_um, double z_um)
      : phantom_(phantom),
        softness_(phantom.softness_),
        narrowing_(narrowing(phantom.settings_, z_um)),
        outlines_(phantom.anatomy_.row(
            static_cast<float>((y_um - phantom.half_height_um_) / phantom.half_height_um_),
            static_cast<float>(z_um / phantom.anatomy_depth_um_))),
        clouds_(row_of(phantom.clouds_, y_um, z_um)),
        grain_(row_of(phantom.grain_, y_um, z_um)),
        lobules_(row_of(phantom.lobules_, y_um, z_um)),
        fibres_(phantom.fibres_.line(y_um, z_um)),
        fine_fibres_(phantom.fine_fibres_.line(y_um, z_um)),
        spongiosa_(row_of(phantom.spongiosa_, y_um, z_um)),
        fine_spongiosa_(row_of(phantom.fine_spongiosa_, y_um, z_um)),
        // Fibres lean: forward above the joint, backward below it.
        lean_um_(0.22 * (y_um - phantom.half_height_um_) +
                 0.04 * phantom.half_height_um_ *
                     wave(static_cast<float>(2.0 * y_um / phantom.half_height_um_))) {}

  Paint paint(double x_um) {
    const auto u = static_cast<float>((x_um - phantom_.half_width_um_) / phantom_.half_width_um_);
    Outlines o = outlines_.at(u);
    o.specimen += narrowing_;
    const float cloud = clouds_.at(x_um);
    const float grain = grain_.at(x_um);

    Paint paint{toned(Tissue::casting, 0.10F * cloud + 0.09F * grain)};
    const float specimen = coverage(o.specimen, softness_);
    if (specimen <= 0.0F) {
      return paint;
    }
    const Colour casting = paint.colour;
    if (std::min({o.femur, o.tibia, o.patella, o.fibula}) >= std::min(kDeepInBone, -softness_)) {
      paint_soft_parts(x_um, o, cloud, grain, paint);
      paint_vessels(o, grain, paint);
      paint_joint(o, cloud, grain, paint);
    }
    paint_bone(x_um, o.femur, o, cloud, grain, paint);
    paint_bone(x_um, o.tibia, o, cloud, grain, paint);
    paint_bone(x_um, o.patella, o, cloud, grain, paint);
    paint_bone(x_um, o.fibula, o, cloud, grain, paint);
    paint.colour = within_levels(mixed(casting, paint.colour, specimen));
    if (specimen < 0.5F) {
      paint.tissue = Tissue::casting;
    }
    return paint;
  }

 private:
  float cover(float distance) const { return coverage(distance, softness_); }

  void lay(Tissue tissue, float tone, float distance, Paint& paint) const {
    if (const float share = cover(distance); share > 0.0F) {
      paint.lay(tissue, toned(tissue, tone), share);
    }
  }

  void paint_soft_parts(double x_um, const Outlines& o, float cloud, float grain, Paint& paint) {
    // Lobules of fat, parted by thin darker lines that come and go.
    const float lobule = lobules_.at(x_um);
    const float septum =
        (0.07F + 0.12F * cloud) * smooth_step(phantom_.bundle_edge_, 0.0F, std::fabs(lobule));
    const float fat_tone = 0.07F * cloud + 0.10F * lobule + 0.06F * grain - septum;
    paint.lay(Tissue::fat, toned(Tissue::fat, fat_tone), 1.0F);
    // Under the subcutaneous fat a thin sheet of fascia wraps everything else.
    const float under_fat = o.specimen + 0.060F + 0.020F * cloud;
    lay(Tissue::fascia, 0.05F * grain, std::fabs(under_fat) - 0.5F * softness_ - 0.002F, paint);
    const float muscle = std::min(
        {o.rear_upper_muscle, o.rear_lower_muscle, o.front_upper_muscle, o.front_lower_muscle});
    const float inside_fascia = std::max(muscle, under_fat + 0.012F);
    if (const float share = cover(inside_fascia); share > 0.0F) {
      paint_muscle(x_um, inside_fascia, share, cloud, grain, paint);
    }
    if (const float share = cover(o.fat_pad); share > 0.0F) {
      paint.lay(
          Tissue::fat,
          mixed(toned(Tissue::fat, fat_tone), colour_of(Tissue::muscle), 0.10F + 0.08F * cloud),
          share);
    }
    if (const float share = cover(o.tendon); share > 0.0F) {
      const float fibre = fine_fibres_.at(x_um + lean_um_);
      paint.lay(Tissue::tendon, toned(Tissue::tendon, 0.14F * fibre + 0.04F * grain), share);
    }
  }

  void paint_muscle(double x_um, float distance, float share, float cloud, float grain,
                    Paint& paint) {
    const float bundle = fibres_.at(x_um + lean_um_);
    const float fibre = fine_fibres_.at(x_um + lean_um_);
    const Colour flesh =
        toned(Tissue::muscle, 0.22F * fibre + 0.14F * bundle + 0.10F * cloud + 0.06F * grain);
    // Perimysium: pale lines between the bundles, and a sheath around the belly.
    const float between = 0.45F * smooth_step(phantom_.bundle_edge_, 0.0F, std::fabs(bundle));
    const float sheath = smooth_step(-2.5F * softness_, 0.0F, distance);
    paint.lay(Tissue::muscle,
              mixed(flesh, colour_of(Tissue::fascia), std::max(between, 0.7F * sheath)), share);
  }

  void paint_vessels(const Outlines& o, float grain, Paint& paint) {
    lay(Tissue::nerve, 0.10F * grain, o.nerve, paint);
    paint_tube(Tissue::fascia, Tissue::vein_blood, o.vein, 0.006F, grain, paint);
    paint_tube(Tissue::artery_wall, Tissue::artery_blood, o.artery, 0.014F, grain, paint);
    paint_tube(Tissue::fascia, Tissue::vein_blood, o.small_vein, 0.005F, grain, paint);
    paint_tube(Tissue::artery_wall, Tissue::artery_blood, o.small_artery, 0.010F, grain, paint);
  }

  void paint_tube(Tissue wall, Tissue blood, float distance, float wall_thickness, float grain,
                  Paint& paint) {
    lay(wall, 0.05F * grain, distance, paint);
    lay(blood, 0.06F * grain, distance + wall_thickness, paint);
  }

  void paint_joint(const Outlines& o, float cloud, float grain, Paint& paint) {
    lay(Tissue::synovia, 0.08F * cloud + 0.03F * grain, o.joint_space, paint);
    lay(Tissue::meniscus, 0.06F * cloud + 0.05F * grain, o.meniscus, paint);
    paint_cartilage(o.femur, o.femur_cartilage, grain, paint);
    paint_cartilage(o.tibia, o.tibia_cartilage, grain, paint);
    paint_cartilage(o.patella, o.patella_cartilage, grain, paint);
  }

  void paint_cartilage(float bone, float thickness, float grain, Paint& paint) {
    const float share = cover(bone - thickness);
    if (thickness <= softness_ || share <= 0.0F) {
      return;
    }
    // Paler towards the bone, glassier towards the gap.
    const float depth = 1.0F - std::clamp(bone / thickness, 0.0F, 1.0F);
    const Colour deep = mixed(colour_of(Tissue::cartilage), colour_of(Tissue::cortical_bone), 0.3F);
    paint.lay(Tissue::cartilage,
              (1.0F + 0.04F * grain) * mixed(colour_of(Tissue::cartilage), deep, depth), share);
  }

  void paint_bone(double x_um, float distance, const Outlines& o, float cloud, float grain,
                  Paint& paint) {
    const float share = cover(distance);
    if (share <= 0.0F) {
      return;
    }
    paint.lay(Tissue::cortical_bone, toned(Tissue::cortical_bone, 0.05F * cloud + 0.05F * grain),
              share);
    const float cortex = 0.016F + 0.034F * o.shaft;
    const float core = cover(distance + cortex);
    if (core <= 0.0F) {
      return;
    }
    // Red marrow near the joint, fatty marrow in the shaft, in clouds.
    const float fatty = smooth_step(0.25F, 0.75F, 0.32F + 0.55F * o.shaft + 0.5F * cloud);
    const Colour marrow = (1.0F + 0.08F * grain) * mixed(colour_of(Tissue::red_marrow),
                                                         colour_of(Tissue::yellow_marrow), fatty);
    paint.lay(fatty > 0.5F ? Tissue::yellow_marrow : Tissue::red_marrow, marrow, core);

    // Trabeculae are the thin walls where either of two noises passes through zero; they are
    // thicker under the cortex and at the growth line, and thin out in the shaft.
    const float broad = spongiosa_.at(x_um);
    const float fine = fine_spongiosa_.at(x_um);
    const float wall = std::min(std::fabs(broad + 0.45F * fine), 1.35F * std::fabs(fine - 0.12F));
    const float near_edge = smooth_step(0.10F, 0.0F, -distance - cortex);
    const float scar = smooth_step(0.012F + softness_, 0.004F, o.growth_line);
    const float thickness =
        0.015F + 0.060F * near_edge - 0.085F * o.shaft + 0.28F * scar * (1.0F - o.shaft);
    const float trabecula = core *
                            (1.0F - smooth_step(thickness, thickness + phantom_.wall_edge_, wall)) *
                            (1.0F - smooth_step(0.6F, 1.0F, o.shaft));
    paint.lay(Tissue::trabecula, toned(Tissue::trabecula, 0.06F * cloud + 0.06F * grain),
              trabecula);
  }

  const Phantom& phantom_;
  float softness_;
  float narrowing_;
  Anatomy::Row outlines_;
  GradientNoise::Line clouds_;
  GradientNoise::Line grain_;
  GradientNoise::Line lobules_;
  GradientNoise::Line fibres_;
  GradientNoise::Line fine_fibres_;
  GradientNoise::Line spongiosa_;
  GradientNoise::Line fine_spongiosa_;
  double lean_um_;
};

namespace {

constexpr double kFibreShare = 0.022;  // cells as shares of the picture's lesser side
constexpr double kSpongiosaShare = 0.029;

/// Textures grow with the specimen, but never finer than the finest detail allows.
double cell(const PhantomSettings& s, double share_of_size, double least_details) {
  return std::max(share_of_size * std::min(s.width_um, s.height_um), least_details * s.detail_um);
}

/// How far noise of this cell rises over the finest detail, at its usual slope of 1.5 a cell: edges
/// made by a threshold on the noise are that soft.
float rise_over_detail(const PhantomSettings& s, double cell_um) {
  return static_cast<float>(1.5 * s.detail_um / cell_um);
}

}  // namespace

Phantom::Phantom(const PhantomSettings& settings)
    : settings_(settings),
      half_width_um_(0.5 * settings.width_um),
      half_height_um_(0.5 * settings.height_um),
      anatomy_depth_um_(
          std::max(settings.depth_um, 0.17 * std::min(settings.width_um, settings.height_um))),
      softness_(static_cast<float>(settings.detail_um / std::min(half_width_um_, half_height_um_))),
      wall_edge_(rise_over_detail(settings, cell(settings, kSpongiosaShare, 6))),
      bundle_edge_(rise_over_detail(settings, cell(settings, kFibreShare, 4))),
      anatomy_(settings.seed),
      clouds_(settings.seed + 1, cell(settings, 0.08, 8)),
      grain_(settings.seed + 2, 2.0 * settings.detail_um),
      lobules_(settings.seed + 3, cell(settings, kFibreShare, 4)),
      fibres_(settings.seed + 4, cell(settings, kFibreShare, 4),
              10 * cell(settings, kFibreShare, 4), 3 * cell(settings, kFibreShare, 4)),
      fine_fibres_(settings.seed + 5, cell(settings, 0.006, 2), 10 * cell(settings, 0.006, 2),
                   3 * cell(settings, 0.006, 2)),
      spongiosa_(settings.seed + 6, cell(settings, kSpongiosaShare, 6)),
      fine_spongiosa_(settings.seed + 7, cell(settings, 0.64 * kSpongiosaShare, 4)) {}

Colour Phantom::colour_at(double x_um, double y_um, double z_um) const {
  return Brush(*this, y_um, z_um).paint(x_um).colour;
}

Tissue Phantom::tissue_at(double x_um, double y_um, double z_um) const {
  return Brush(*this, y_um, z_um).paint(x_um).tissue;
}

void Phantom::paint_row(double x_um, double step_um, double y_um, double z_um,
                        std::span<Colour> row) const {
  Brush brush(*this, y_um, z_um);
  for (std::size_t i = 0; i < row.size(); ++i) {
    row[i] = brush.paint(x_um + static_cast<double>(i) * step_um).colour;
  }
}

}  // namespace biotomy::sim
