#include "acquisition/quality/sharpness_judgement.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "acquisition/quality/sharpness_comparison.hpp"

namespace biotomy::acquisition {
namespace {

constexpr double kBenefitOfDoubt = 2.0;  ///< standard errors
constexpr const char* kBlurred = "blurred";

double lowered(double limit, double error) {
  return limit * std::exp(-kBenefitOfDoubt * error);
}

void judge_ratio(const SharpnessComparison& found, const std::string& to,
                 const QualityThresholds& thresholds, Judgement& judgement) {
  const std::string reason = "the sharpness is %.3f of " + to + ", below %.3f; " +
                             std::to_string(found.below) + " of " + std::to_string(found.tiles) +
                             " tiles";
  judgement.at_least("sharpness_ratio", found.ratio.value,
                     lowered(thresholds.minimum_sharpness_ratio, found.ratio.error), kBlurred,
                     reason.c_str());
  judgement.at_least("sharpness_anisotropy", found.anisotropy.value,
                     lowered(thresholds.minimum_sharpness_anisotropy, found.anisotropy.error),
                     "smeared",
                     "along one axis the frame has %.3f of the other's sharpness, below %.3f: "
                     "something vibrated or moved");
}

}  // namespace

void judge_sharpness(const SharpnessRecord& record, std::int64_t layer,
                     const QualityThresholds& thresholds, Judgement& judgement) {
  Assessment& result = judgement.result();
  const FrameMeasures& frame = *result.measures;
  result.sharpness = sharpness(frame);

  const double limit = thresholds.minimum_sharpness_ratio;
  std::optional<SharpnessComparison> to_peak;
  if (record.peak()) to_peak = compare_sharpness(frame, {&record.peak(), 1}, limit);
  std::optional<SharpnessComparison> to_record;
  if (!record.recent().empty()) to_record = compare_sharpness(frame, record.recent(), limit);
  if (to_peak) result.sharpness_to_peak = to_peak->ratio.value;

  const bool searched_here = to_peak && record.peak_layer() == layer;
  if (searched_here) {
    judge_ratio(*to_peak, "this layer's focus peak", thresholds, judgement);
    if (to_record) {
      judgement.at_least(
          "sharpness_to_record", to_record->ratio.value,
          lowered(thresholds.minimum_sharpness_to_record, to_record->ratio.error), kBlurred,
          "the sharpness is %.3f of the last layers', below %.3f, although the focus "
          "was searched: look at lens, column and face");
    }
  } else if (to_record) {
    judge_ratio(*to_record, "the last layers'", thresholds, judgement);
  } else if (to_peak) {
    judge_ratio(*to_peak, "the last focus peak", thresholds, judgement);
  } else {
    judgement.leave_open("nothing to compare the sharpness with");
  }
}

}  // namespace biotomy::acquisition
