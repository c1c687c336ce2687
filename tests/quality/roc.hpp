#pragma once

#include <vector>

namespace biotomy::tests {

/// The values that one metric has for good frames and for bad ones.
struct MetricValues {
  std::vector<double> good;
  std::vector<double> bad;
  bool low_is_bad = false;
};

/// The area under the receiver operating characteristic: the probability that of a good and a bad
/// frame, drawn at random, the metric tells which is which; ties count half. After Hanley and
/// McNeil, "The meaning and use of the area under a receiver operating characteristic (ROC) curve",
/// Radiology 143 (1982) 29-36. Not a number without frames of both kinds.
double area_under_roc(const MetricValues& values);

/// A point of the characteristic: the part of the bad frames that a limit detects that was chosen
/// so that it rejects at most `false_alarms` (a part) of the good ones.
double detection_at(const MetricValues& values, double false_alarms);

}  // namespace biotomy::tests
