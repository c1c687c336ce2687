#include "sim/phantom/anatomy.hpp"

#include <algorithm>

#include "sim/phantom/gradient_noise.hpp"
#include "sim/phantom/signed_distance.hpp"

namespace biotomy::sim {

namespace {

/// The bones and the specimen's ends are sawn off flush here.
constexpr float kSpecimenHalfHeight = 0.86F;
constexpr float kSpecimenHalfWidth = 0.79F;

/// A tube that runs along v and winds through the layers: `away` is its distance from the plane.
float to_tube(float u, float centre_u, float away, float radius) {
  return length(u - centre_u, away) - radius;
}

}  // namespace

Anatomy::Anatomy(std::uint64_t seed) {
  for (int i = 0; i < kPhases; ++i) {
    phases_[i] = mixed_fraction(seed, 100 + static_cast<std::uint64_t>(i));
  }
}

Anatomy::Row::Row(const Anatomy& anatomy, float v, float w) : anatomy_(anatomy), v_(v), w_(w) {
  const auto phase = [&](int which) { return anatomy.phase(which); };
  drift_u_ = 0.022F * wave(0.55F * v + 0.45F * w + phase(0)) +
             0.010F * wave(1.6F * v - 0.8F * w + phase(1));
  condyle_u_ = -0.02F + 0.05F * wave(0.5F * w + phase(2));
  condyle_v_ = -0.25F + 0.02F * wave(0.45F * w + phase(3));
  condyle_width_ = 0.335F + 0.035F * wave(0.6F * w + phase(3));
  condyle_height_ = 0.245F + 0.025F * wave(0.5F * w + phase(4));
  plateau_v_ = 0.335F + 0.015F * wave(0.6F * w + phase(5));
  femur_shaft_u_ = -0.06F + 0.04F * v + 0.03F * wave(0.5F * w + phase(5));
  tibia_shaft_u_ = 0.02F - 0.05F * v + 0.03F * wave(0.5F * w + phase(6));
  fibula_u_ = 0.33F - 0.04F * v + 0.02F * wave(0.4F * v + phase(7));
  fibula_away_ = 0.07F * wave(0.25F * v + 0.5F * w + phase(7));
  artery_u_ = 0.44F + 0.05F * wave(0.7F * v + 0.3F * w + phase(8));
  artery_away_ = 0.075F * wave(0.55F * v + 0.9F * w + phase(8));
  vein_u_ = artery_u_ + 0.090F + 0.020F * wave(0.8F * v + phase(9));
  vein_away_ = 0.085F * wave(0.45F * v + 0.8F * w + phase(9));
  nerve_u_ = artery_u_ + 0.165F + 0.02F * wave(0.5F * v + phase(10));
  nerve_away_ = 0.06F * wave(0.35F * v + 0.6F * w + phase(10));
}

Outlines Anatomy::Row::at(float u) const {
  Outlines o;
  const float bent_u = u + drift_u_;
  const float bent_v = v_ + 0.020F * wave(0.6F * u + 0.4F * w_ + anatomy_.phase(11));
  o.specimen = to_rounded_box(bent_u, v_, kSpecimenHalfWidth, kSpecimenHalfHeight, 0.30F);
  if (o.specimen > 0.1F) {
    return o;  // casting all round
  }
  outline_bones(bent_u, bent_v, o);
  if (std::min({o.femur, o.tibia, o.patella, o.fibula}) < kDeepInBone) {
    return o;
  }
  outline_soft_parts(bent_u, bent_v, o);
  outline_vessels(bent_u, o);
  return o;
}

void Anatomy::Row::outline_bones(float u, float v, Outlines& o) const {
  if (v < plateau_v_) {
    const float condyle =
        to_ellipse(u - condyle_u_, v - condyle_v_, condyle_width_, condyle_height_);
    const float shaft = v < -0.4F ? std::fabs(u - femur_shaft_u_) - 0.185F
                                  : to_circle(u - femur_shaft_u_, v + 0.4F, 0.185F);
    o.femur = std::max(smooth_union(condyle, shaft, 0.22F), o.specimen + 0.012F);
    o.femur_cartilage = 0.058F * smooth_step(-0.38F, -0.2F, v);
    o.shaft = smooth_step(-0.42F, -0.66F, v);
    const float scar = v + 0.36F - 0.35F * (u - condyle_u_) * (u - condyle_u_) +
                       0.018F * wave(1.9F * u + 0.5F * w_);
    o.growth_line = std::fabs(scar);
  }
  if (v > condyle_v_) {
    const float plateau = to_ellipse(u - 0.02F, v - plateau_v_, 0.385F, 0.17F);
    const float shaft = v > 0.5F ? std::fabs(u - tibia_shaft_u_) - 0.165F
                                 : to_circle(u - tibia_shaft_u_, v - 0.5F, 0.165F);
    o.tibia = std::max(smooth_union(plateau, shaft, 0.2F), o.specimen + 0.012F);
    o.tibia_cartilage = 0.046F * smooth_step(plateau_v_ + 0.02F, plateau_v_ - 0.1F, v);
    const float scar =
        v - 0.455F + 0.25F * (u - 0.02F) * (u - 0.02F) + 0.016F * wave(2.1F * u - 0.6F * w_);
    o.growth_line = std::min(o.growth_line, std::fabs(scar));
    o.shaft = std::max(o.shaft, smooth_step(0.52F, 0.74F, v));
    o.fibula =
        std::max({to_tube(u, fibula_u_, fibula_away_, 0.075F), 0.40F - v, o.specimen + 0.012F});
  }
  const float patella_u = u + 0.545F;
  const float patella_v = v + 0.26F;
  o.patella = to_ellipse(patella_u + 0.18F * patella_v, patella_v, 0.085F, 0.185F);
  o.patella_cartilage = 0.042F * smooth_step(0.0F, 0.05F, patella_u + 0.18F * patella_v);
}

void Anatomy::Row::outline_soft_parts(float u, float v, Outlines& o) const {
  const float swing = 0.05F * wave(0.5F * w_ + anatomy_.phase(6));
  if (u > 0.0F) {
    o.rear_upper_muscle = to_ellipse(u - 0.45F - swing, v + 0.62F, 0.235F, 0.56F);
    o.rear_lower_muscle = to_ellipse(u - 0.52F + swing, v - 0.62F, 0.19F, 0.50F);
  } else {
    o.front_upper_muscle = to_ellipse(u + 0.46F, v + 0.78F, 0.19F + swing, 0.34F);
    o.front_lower_muscle = to_ellipse(u + 0.43F, v - 0.80F, 0.16F - swing, 0.30F);
    o.tendon = std::min(to_band(u, v, -0.54F, -0.48F, -0.45F, -0.72F, 0.034F),
                        to_band(u, v, -0.575F, -0.12F, -0.385F, 0.44F, 0.032F));
    o.fat_pad = to_ellipse(u + 0.41F - 0.35F * (v - 0.08F), v - 0.08F, 0.15F, 0.22F);
  }
  o.tendon = std::min(o.tendon, to_band(u, v, 0.36F, -0.30F, 0.425F, 0.34F, 0.022F));
  o.joint_space = std::min(to_ellipse(u - 0.02F, v - 0.085F, 0.40F, 0.15F),
                           to_ellipse(u + 0.43F, v + 0.26F, 0.075F, 0.22F));
  const float front = to_ellipse(u + 0.315F, v - 0.085F, 0.115F, 0.085F);
  const float rear = to_ellipse(u - 0.335F, v - 0.085F, 0.105F, 0.08F);
  o.meniscus = std::min(front, rear);
}

void Anatomy::Row::outline_vessels(float u, Outlines& o) const {
  o.artery = to_tube(u, artery_u_, artery_away_, 0.042F);
  o.vein = to_tube(u, vein_u_, vein_away_, 0.050F);
  o.nerve = to_tube(u, nerve_u_, nerve_away_, 0.030F);
  // A pair that crosses the layers instead: round on every face.
  const float across_u = u - 0.60F - 0.05F * wave(0.6F * w_ + anatomy_.phase(8));
  const float across_v = v_ - 0.06F - 0.10F * wave(0.5F * w_ + anatomy_.phase(9));
  o.small_artery = to_circle(across_u, across_v, 0.026F);
  o.small_vein = to_circle(across_u - 0.075F, across_v - 0.05F, 0.034F);
}

}  // namespace biotomy::sim
