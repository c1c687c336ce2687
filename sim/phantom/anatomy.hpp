#pragma once

#include <cstdint>

namespace biotomy::sim {

/// How deep inside a bone nothing else needs to be known.
inline constexpr float kDeepInBone = -0.08F;

/// How far a point is from the outlines of the joint, negative inside. Lengths are in half widths
/// of the specimen's picture; away from an outline they are estimates, near it they are good.
struct Outlines {
  float specimen = 1;
  float rear_upper_muscle = 1;
  float rear_lower_muscle = 1;
  float front_upper_muscle = 1;
  float front_lower_muscle = 1;
  float tendon = 1;       ///< quadriceps tendon, patellar ligament, rear capsule
  float fat_pad = 1;      ///< between ligament, femur and tibia
  float joint_space = 1;  ///< filled with synovia where nothing else is
  float meniscus = 1;
  float femur = 1;
  float tibia = 1;
  float patella = 1;
  float fibula = 1;
  float femur_cartilage = 0;  ///< thickness over the femur's outline at this place
  float tibia_cartilage = 0;
  float patella_cartilage = 0;
  float growth_line = 1;  ///< distance from the scar of the growth plate
  float shaft = 0;        ///< 0 at the joint, 1 in the shaft of a long bone
  float artery = 1;
  float vein = 1;
  float nerve = 1;
  float small_artery = 1;
  float small_vein = 1;
};

/// The shapes of a knee-like joint cut lengthwise: femur above, tibia below, patella in front
/// (left), muscles and vessels at the back. Every outline drifts with the depth, so that sections
/// across the layers are worth looking at.
///
/// Coordinates: u right and v down, both -1..1 over the picture; w is the depth, 0 at the first
/// face, about 1 at the deepest.
class Anatomy {
 public:
  explicit Anatomy(std::uint64_t seed);

  /// All that depends on v and w alone is worked out once for a row of points.
  class Row {
   public:
    Row(const Anatomy& anatomy, float v, float w);
    /// What lies under the casting or deep inside a bone is left at "far away".
    Outlines at(float u) const;

   private:
    void outline_bones(float u, float v, Outlines& o) const;
    void outline_soft_parts(float u, float v, Outlines& o) const;
    void outline_vessels(float u, Outlines& o) const;

    const Anatomy& anatomy_;
    float v_;
    float w_;
    float drift_u_;
    float condyle_u_;
    float condyle_v_;
    float condyle_width_;
    float condyle_height_;
    float plateau_v_;
    float femur_shaft_u_;
    float tibia_shaft_u_;
    float fibula_u_;
    float fibula_away_;
    float artery_u_;
    float artery_away_;
    float vein_u_;
    float vein_away_;
    float nerve_u_;
    float nerve_away_;
  };

  Row row(float v, float w) const { return {*this, v, w}; }

 private:
  float phase(int which) const { return phases_[which]; }

  static constexpr int kPhases = 12;
  float phases_[kPhases] = {};
};

}  // namespace biotomy::sim
