#pragma once

#include <array>
#include <span>
#include <string_view>

namespace biotomy::tests {

/// What may be wrong with a labelled frame.
enum class Defect {
  none,
  defocus,
  smear,
  lamp_dark,
  lamp_bright,
  uneven_light,
  clipped,
  colour_cast,
  debris,
  frost,
  glare,
  torn,
  partial,
  black,
  stale,
  unchanged,
  part_unchanged,
  shift,
  shadow,
  part_blurred,
};

/// A defect, the strengths in which it is made, and what an assessment should make of them.
/// Between `harmless` and `harmful` is the grey zone, in which either answer is right.
struct DefectKind {
  static constexpr double kUsualGoal = 0.98;

  Defect defect;
  const char* name;
  const char* unit;
  double least;     ///< strength
  double harmless;  ///< up to it the frame is as good as any; less than `least`: never
  double harmful;   ///< from it on the frame must be rejected
  double most;
  int weight;                             ///< how often it is made, relative to the others
  std::array<std::string_view, 3> slugs;  ///< of the reasons that name it
  std::string_view metric;                ///< that is meant for it
  double goal = kUsualGoal;               ///< part of the harmful frames that must be rejected
  bool is_change = false;  ///< the metric is a change up or down, of which the amount counts
};

/// All but `none`.
std::span<const DefectKind> defect_kinds();

const DefectKind& kind_of(Defect defect);

}  // namespace biotomy::tests
