#pragma once

#include <functional>
#include <vector>

#include "acquisition/quality/assessment.hpp"
#include "tests/quality/labelled_set.hpp"

namespace biotomy::tests {

/// A labelled frame's label and what the daemon's assessment made of the frame.
struct JudgedFrame {
  int sequence = 0;  ///< number in the set
  int layer = 0;
  Defect defect = Defect::none;
  double strength = 0.0;
  double contrast = 1.0;
  Demand demand = Demand::accept;
  bool rejected = false;
  std::string slug;
  std::string reason;
  std::vector<acquisition::Metric> metrics;
  double seconds = 0.0;  ///< that the assessment took

  /// Null when the frame was not given this metric.
  const acquisition::Metric* metric(std::string_view name) const;
};

/// Makes the set's frames and has each judged by the daemon's assess() with its default thresholds.
/// A layer is accepted with its good frame, whatever was found of it; so one wrong answer does not
/// spoil the next. The answer is in the order of the set whatever the number of threads; images are
/// not kept.
std::vector<JudgedFrame> judge_set(
    const std::vector<SequenceSettings>& set, int threads,
    const std::function<void()>& sequence_done = [] {});

}  // namespace biotomy::tests
