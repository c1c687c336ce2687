#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "tests/quality/judged_set.hpp"
#include "tests/quality/roc.hpp"

namespace biotomy::tests {

/// Of so many frames so many were rejected.
struct Rejections {
  int frames = 0;
  int rejected = 0;

  void add(const JudgedFrame& frame);
  double share() const { return frames == 0 ? 0.0 : static_cast<double>(rejected) / frames; }
};

/// What became of the frames with one defect.
struct DefectResult {
  const DefectKind* kind = nullptr;
  Rejections harmless;
  Rejections between;
  Rejections harmful;
  /// Of the harmful ones, the least, the middle and the greatest strengths; each as wide as the
  /// others by ratio.
  std::array<Rejections, 3> by_strength;
  int named = 0;  ///< of the harmful ones that were rejected: for a reason that names the defect
  Rejections alarms;    ///< of the good frames, for such a reason
  MetricValues values;  ///< of the metric that is meant for the defect, where a frame has it

  /// The part of the harmful frames that must be rejected.
  double goal() const;
  bool reached() const { return harmful.share() >= goal(); }

  /// Whether the assessment has the metric.
  bool has_metric() const { return !values.good.empty() && !values.bad.empty(); }
};

/// What the assessment made of a set.
struct SetResults {
  static constexpr double kMostFalseAlarms = 0.005;  ///< of the good frames, for whatever reason

  Rejections all;
  Rejections good;
  std::map<std::string, int> alarms;  ///< good frames that were rejected, by the reason's slug
  std::vector<DefectResult> defects;
  double mean_seconds = 0.0;  ///< of an assessment

  bool reached() const;
};

SetResults results_of(const std::vector<JudgedFrame>& frames);

}  // namespace biotomy::tests
