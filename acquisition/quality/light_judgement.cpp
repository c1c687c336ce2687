#include "acquisition/quality/light_judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace biotomy::acquisition {
namespace {

/// A limit that lies within so many standard deviations of no change at all can't be judged by.
constexpr double kCertain = 3.0;

/// A colour of which the casting material has less, of full scale, tells nothing of a lamp's.
constexpr double kLeastLevel = 0.01;

/// Where both surfaces show casting material, so that a specimen which appears all at once is not
/// taken for it; where the earlier one does if hardly any cell is left, as after a strong cast.
cv::Mat casting_of(const SurfacePrint& before, const SurfacePrint& now,
                   const SurfaceRecord& surfaces) {
  if (!surfaces.casting()) return cv::Mat::zeros(before.light.size(), CV_8UC1);
  const cv::Mat earlier = casting_cells(before.light, *surfaces.casting());
  const cv::Mat both = earlier & casting_cells(now.light, *surfaces.casting());
  constexpr double kLeast = 0.05;  // of the frame
  const bool enough = cv::countNonZero(both) >= kLeast * static_cast<double>(both.total());
  return enough ? both : earlier;
}

void judge_against_last(const SurfaceRecord& surfaces, const QualityThresholds& thresholds,
                        Judgement& judgement) {
  const FrameLight& light = judgement.result().light;
  const LightChange change = light.since_first - surfaces.usual_light();
  const double level_error = std::max(light.measured.level_error, surfaces.level_error());
  const double range_error = std::max(light.measured.range_error, surfaces.range_error());
  const std::string last = "the last layers', more than %.3f";
  const double level = std::expm1(change.brightness().mean());
  if (kCertain * level_error <= thresholds.maximum_brightness_change) {
    // A cast changes the brightness too, and not the other way round.
    judgement.at_most("colour_cast", change.cast(), thresholds.maximum_colour_cast, "colour-cast",
                      ("the colours' light is %.3f apart from " + last +
                       ": look at the lamp and the white balance")
                          .c_str());
    judgement.within("brightness", level, thresholds.maximum_brightness_change,
                     level < 0.0 ? "darker" : "brighter",
                     ("the light is %+.3f beside " + last +
                      ": look at the lamp, the exposure and what stands in the light")
                         .c_str());
  } else {
    judgement.leave_open("too little that is steady to compare the light");
  }
  if (kCertain * range_error <= thresholds.maximum_unevenness) {
    judgement.at_most("evenness", change.brightness().range(), thresholds.maximum_unevenness,
                      "uneven-light",
                      ("over the frame the light is by %.3f otherwise distributed than " + last +
                       ": look at the lamp and what stands in the light")
                          .c_str());
  }
}

void judge_casting(const CastingColour& now, const std::optional<CastingColour>& first,
                   const QualityThresholds& thresholds, Judgement& judgement) {
  std::vector<double> ratios;
  for (std::size_t c = 0; c < kCastingMetrics.size(); ++c) {
    const int i = static_cast<int>(c);
    judgement.at_most(kCastingMetrics.at(c), now.level[i], 1.0, "", "");
    const bool tells = first && first->level[i] >= kLeastLevel && now.level[i] > 0.0;
    if (tells) ratios.push_back(std::log(now.level[i] / first->level[i]));
  }
  if (!first) return;
  judgement.within("brightness_drift", now.brightness() / first->brightness() - 1.0,
                   thresholds.maximum_brightness_drift, "light-drifted",
                   "the casting material's brightness is %+.3f beside the first layer's, more than "
                   "%.3f: the lamp ages, or its light is blocked");
  if (ratios.empty()) return;
  const auto [least, most] = std::ranges::minmax(ratios);
  judgement.at_most("colour_drift", most - least, thresholds.maximum_colour_drift, "colour-drifted",
                    "the casting material's colours are %.3f apart from the first layer's, more "
                    "than %.3f: the lamp or the white balance changed slowly");
}

}  // namespace

FrameLight find_light(const SurfacePrint& surface, const SurfaceRecord& surfaces) {
  FrameLight light;
  const cv::Mat& now = surface.light;
  const SurfacePrint* before = surfaces.surface();
  if (now.empty()) return light;
  if (before == nullptr || before->light.size() != now.size()) {
    light.casting = learn_casting(now);
    return light;
  }
  const cv::Mat casting = casting_of(*before, surface, surfaces);
  light.measured = measure_light(now, before->light, casting);
  light.since_first = surfaces.last_light() + light.measured.change;
  light.casting = surfaces.casting()
                      ? casting_within(now, casting & light.measured.steady, *surfaces.casting())
                      : learn_casting(now);
  return light;
}

void judge_light(const SurfaceRecord& surfaces, const QualityThresholds& thresholds,
                 Judgement& judgement) {
  if (surfaces.surface() != nullptr) judge_against_last(surfaces, thresholds, judgement);
  const std::optional<CastingColour>& casting = judgement.result().light.casting;
  if (casting) judge_casting(*casting, surfaces.first_casting(), thresholds, judgement);
}

}  // namespace biotomy::acquisition
