#include "acquisition/quality/sharpness_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include "acquisition/quality/blurred_part.hpp"
#include "acquisition/quality/sharpness_comparison.hpp"

namespace biotomy::acquisition {
namespace {

/// Standard errors by which a limit is lowered, of both axes together and of one.
constexpr double kDoubt = 0.5;
constexpr double kDoubtOfAxis = 1.0;

/// And what a face's content changes by chance, for all tiles alike; of a frame of one megapixel,
/// on the twin's layers.
constexpr double kContent = 0.010;

/// A movement blurs one axis and leaves the other about as it was: the one's ratio over the other's
/// is below the first, the other's is above the second.
constexpr double kSmeared = 0.95;
constexpr double kLeftAlone = 0.85;

constexpr const char* kBlurred = "blurred";
constexpr const char* kLastLayers = "the last layers'";

bool is_smeared(const SharpnessComparison& found) {
  return found.anisotropy.value < kSmeared &&
         std::max(found.along_x.value, found.along_y.value) > kLeftAlone;
}

double lowered(double limit, double error, const FrameMeasures& frame) {
  const double megapixels = 1e-6 * static_cast<double>(frame.grid.frame.area());
  return limit * std::exp(-error - kContent / std::sqrt(megapixels));
}

void judge_both_axes(const SharpnessComparison& found, const std::string& to,
                     const QualityThresholds& thresholds, Judgement& judgement) {
  const std::string reason = "the sharpness is %.3f of " + to + ", below %.3f; " +
                             std::to_string(found.below) + " of " + std::to_string(found.tiles) +
                             " tiles";
  judgement.at_least("sharpness_ratio", found.ratio.value,
                     lowered(thresholds.minimum_sharpness_ratio, kDoubt * found.ratio.error,
                             *judgement.result().measures),
                     kBlurred, reason.c_str());
}

void judge_weaker_axis(const SharpnessComparison& found, const std::string& to, bool smeared,
                       const QualityThresholds& thresholds, Judgement& judgement) {
  const bool is_x = found.along_x.value < found.along_y.value;
  const SharpnessComparison::Estimate& weaker = is_x ? found.along_x : found.along_y;
  const std::string reason = std::string("along ") + (is_x ? "x" : "y") +
                             " the sharpness is %.3f of " + to + ", below %.3f" +
                             (smeared ? ": something vibrated or moved" : "");
  judgement.at_least("sharpness_along_axis", weaker.value,
                     lowered(thresholds.minimum_sharpness_along_axis, kDoubtOfAxis * weaker.error,
                             *judgement.result().measures),
                     smeared ? "smeared" : kBlurred, reason.c_str());
}

using References = std::span<const SharpnessRecord::Frame>;

bool judge_contrast(References references, const std::string& to,
                    const QualityThresholds& thresholds, Judgement& judgement) {
  const auto contrast = compare_contrast(*judgement.result().measures, references);
  if (!contrast) return false;
  const std::string reason = "the contrast of fine detail is %.3f of " + to + ", below %.3f";
  return judgement.at_least("fine_contrast", *contrast, thresholds.minimum_fine_contrast, kBlurred,
                            reason.c_str());
}

void judge_blurred_part(References references, const QualityThresholds& thresholds,
                        Judgement& judgement) {
  const auto part = blurred_part(*judgement.result().measures, references);
  if (!part) return;
  judgement.at_most("blurred_part", *part, thresholds.maximum_blurred_part, kBlurred,
                    "%.3f of the frame, in one piece, is blurred, more than %.3f: look for a drop "
                    "or breath on lens and face, and whether the face is level");
}

/// What the frame is most likely comes first: it gives the reason.
void judge_ratio(const SharpnessComparison& found, const std::string& to,
                 const QualityThresholds& thresholds, Judgement& judgement) {
  const bool smeared = is_smeared(found);
  if (smeared) judge_weaker_axis(found, to, smeared, thresholds, judgement);
  judge_both_axes(found, to, thresholds, judgement);
  if (!smeared) judge_weaker_axis(found, to, smeared, thresholds, judgement);
}

}  // namespace

bool judge_sharpness(const SharpnessRecord& record, std::int64_t layer,
                     const QualityThresholds& thresholds, Judgement& judgement) {
  Assessment& result = judgement.result();
  const FrameMeasures& frame = *result.measures;
  result.sharpness = sharpness(frame);

  const double limit = thresholds.minimum_sharpness_ratio;
  const References peak(&record.peak(), record.peak() ? 1 : 0);
  const References recent = record.recent();
  const auto to_peak = compare_sharpness(frame, peak, limit);
  const auto to_record = compare_sharpness(frame, recent, limit);
  if (to_peak) result.sharpness_to_peak = to_peak->ratio.value;

  if (to_peak && record.peak_layer() == layer) {
    judge_ratio(*to_peak, "this layer's focus peak", thresholds, judgement);
    if (to_record) {
      judgement.at_least(
          "sharpness_to_record", to_record->ratio.value,
          lowered(thresholds.minimum_sharpness_to_record, kDoubt * to_record->ratio.error, frame),
          kBlurred,
          "the sharpness is %.3f of the last layers', below %.3f, although the focus "
          "was searched: look at lens, column and face");
    }
  } else if (to_record) {
    judge_ratio(*to_record, kLastLayers, thresholds, judgement);
  } else if (to_peak) {
    judge_ratio(*to_peak, "the last focus peak", thresholds, judgement);
  } else {
    judgement.leave_open("nothing to compare the sharpness with");
  }
  const bool is_of_layer = to_peak && record.peak_layer() == layer;
  judge_blurred_part(is_of_layer || recent.empty() ? peak : recent, thresholds, judgement);
  // A search that ended far off has a peak without contrast too: the record comes first.
  return recent.empty() ? judge_contrast(peak, "the last focus peak", thresholds, judgement)
                        : judge_contrast(recent, kLastLayers, thresholds, judgement);
}

}  // namespace biotomy::acquisition
