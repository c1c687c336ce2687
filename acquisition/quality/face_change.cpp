#include "acquisition/quality/face_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "acquisition/quality/noise_moments.hpp"

namespace biotomy::acquisition {
namespace {

using Patch = FacePrint::Patch;

// A patch is kept with room for the shift and one pixel more for the derivatives.
constexpr int kMostShift = FacePrint::kReach - 1;
/// Where less than this part of a patch's energy is the face's own, there is nothing to tell by.
constexpr double kLeastContent = 0.5;
/// Detail that is weaker than this part of the other's is not the same detail, blurred.
constexpr double kFaded = 0.25;
/// Pixels over which the band's finer Gaussian spreads noise: 4πσ².
constexpr double kNoiseArea = 12.6;
/// Directions in which the predictors do not differ by more than this tell nothing.
constexpr double kLeastDirection = 1e-4;
/// Judged is where at least one patch in so many has content: of the whole, so that dust on the
/// lens over bare casting material isn't taken for a face that doesn't change; of a row or column.
constexpr std::size_t kWholeShare = 8;
constexpr std::size_t kLineShare = 4;

constexpr std::size_t kPredictors = kDerivatives;
constexpr std::size_t kFields = kPredictors + 1;
constexpr std::size_t kWidest = FacePrint::kMostCore;
/// Sums of products of the fields: the face to be explained, then its predictors.
using Moments = std::array<std::array<double, kFields>, kFields>;
using FieldRows = std::array<std::array<float, kWidest>, kFields>;

cv::Rect core_of(const cv::Mat& patch) {
  return {FacePrint::kReach, FacePrint::kReach, patch.cols - 2 * FacePrint::kReach,
          patch.rows - 2 * FacePrint::kReach};
}

double energy(const cv::Mat& patch) {
  const cv::Mat core = patch(core_of(patch));
  return core.dot(core);
}

/// The energy of a patch's detail itself and of its noise.
struct Strength {
  double signal = 0.0;
  double noise = 0.0;

  Strength(const Patch& patch, const std::optional<BandNoise>& known)
      : noise(known ? known->at(patch.brightness) * core_of(patch.detail).area()
                    : energy(patch.noise)) {
    signal = std::max(0.0, energy(patch.detail) - noise);
  }
  bool has_content() const { return signal > 0.0 && signal >= kLeastContent * (signal + noise); }
};

/// In eight sums side by side, which compilers turn into vectors without changing any result.
double product(const std::array<float, kWidest>& a, const std::array<float, kWidest>& b,
               std::size_t count) {
  constexpr std::size_t kLanes = 8;
  std::array<float, kLanes> sums{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      sums[lane] += a[i + lane] * b[i + lane];
    }
  }
  for (; i < count; ++i) {
    sums[0] += a[i] * b[i];
  }
  double sum = 0.0;
  for (const float part : sums) sum += static_cast<double>(part);
  return sum;
}

/// The value and its derivatives, to the second order, of the predicting face at the places of one
/// row of the other.
void fill_fields(const cv::Mat& target, const cv::Mat& predictor, int y, int begin, int count,
                 cv::Point shift, FieldRows& fields) {
  const float* t = target.ptr<float>(y) + begin;
  const int x0 = begin + shift.x;
  const float* above = predictor.ptr<float>(y + shift.y - 1) + x0;
  const float* here = predictor.ptr<float>(y + shift.y) + x0;
  const float* below = predictor.ptr<float>(y + shift.y + 1) + x0;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    fields[0][k] = t[i];
    fields[1][k] = here[i];
    fields[2][k] = 0.5F * (here[i + 1] - here[i - 1]);
    fields[3][k] = 0.5F * (below[i] - above[i]);
    fields[4][k] = here[i + 1] + here[i - 1] - 2.0F * here[i];
    fields[5][k] = below[i] + above[i] - 2.0F * here[i];
    fields[6][k] = 0.25F * (below[i + 1] + above[i - 1] - below[i - 1] - above[i + 1]);
  }
}

void add_moments(const cv::Mat& target, const cv::Mat& predictor, cv::Point shift, double sign,
                 Moments& moments) {
  FieldRows fields;
  const cv::Rect core = core_of(target);
  const auto count = static_cast<std::size_t>(core.width);
  for (int y = core.y; y < core.y + core.height; ++y) {
    fill_fields(target, predictor, y, core.x, core.width, shift, fields);
    for (std::size_t i = 0; i < kFields; ++i) {
      for (std::size_t j = i; j < kFields; ++j) {
        moments[i][j] += sign * product(fields[i], fields[j], count);
      }
    }
  }
}

/// Noise whose strength alone is known: it has nothing in common between the two.
void take_out_noise(double of_target, double of_predictor, Moments& moments) {
  const DerivativeMoments& unit = unit_noise_moments();
  moments[0][0] -= of_target;
  for (std::size_t i = 0; i < kPredictors; ++i) {
    for (std::size_t j = i; j < kPredictors; ++j) {
      moments[i + 1][j + 1] -= of_predictor * unit[i][j];
    }
  }
}

/// The part of the target's energy that the best mixture of the predictors explains.
double explained_share(const Moments& moments) {
  constexpr int kSize = static_cast<int>(kPredictors);
  // Predictors of unit energy, so that all directions are compared alike.
  std::array<double, kPredictors> scale{};
  for (std::size_t i = 0; i < kPredictors; ++i) {
    const double own = moments[i + 1][i + 1];
    scale[i] = own > 0.0 ? 1.0 / std::sqrt(own) : 0.0;
  }
  cv::Mat products(kSize, kSize, CV_64F);
  cv::Mat with_target(kSize, 1, CV_64F);
  for (int i = 0; i < kSize; ++i) {
    const auto a = static_cast<std::size_t>(i);
    with_target.at<double>(i) = moments[0][a + 1] * scale[a];
    for (int j = i; j < kSize; ++j) {
      const auto b = static_cast<std::size_t>(j);
      products.at<double>(i, j) = products.at<double>(j, i) =
          moments[a + 1][b + 1] * scale[a] * scale[b];
    }
  }
  cv::Mat sizes;
  cv::Mat directions;
  cv::eigen(products, sizes, directions);
  const cv::Mat along = directions * with_target;
  double explained = 0.0;
  for (int i = 0; i < kSize; ++i) {
    const double size = sizes.at<double>(i);
    if (size > kLeastDirection * sizes.at<double>(0)) {
      explained += along.at<double>(i) * along.at<double>(i) / size;
    }
  }
  return explained / moments[0][0];
}

/// Nothing without content in either of the two.
std::optional<Change> change_of_patch(const Patch& now, const Patch& before, cv::Point shift,
                                      const std::optional<BandNoise>& noise) {
  const Strength strength_now(now, noise);
  const Strength strength_before(before, noise);
  const bool now_is_stronger = strength_now.signal > strength_before.signal;
  const Strength& strong = now_is_stronger ? strength_now : strength_before;
  const Strength& weak = now_is_stronger ? strength_before : strength_now;
  if (!strong.has_content()) return std::nullopt;
  if (weak.signal < kFaded * strong.signal) return Change{.value = 1.0, .error = 0.0};

  const Patch& predictor = now_is_stronger ? now : before;
  const Patch& target = now_is_stronger ? before : now;
  const cv::Point to_predictor = now_is_stronger ? -shift : shift;
  Moments moments{};
  add_moments(target.detail, predictor.detail, to_predictor, 1.0, moments);
  if (noise) {
    take_out_noise(weak.noise, strong.noise, moments);
  } else {
    add_moments(target.noise, predictor.noise, to_predictor, -1.0, moments);
  }
  if (moments[0][0] <= 0.0) return std::nullopt;

  // Both the noise left over and the noise taken out are known only as well as so many independent
  // values tell them.
  const double independent = static_cast<double>(core_of(target.detail).area()) / kNoiseArea;
  const double relative_noise = strong.noise / strong.signal + weak.noise / weak.signal;
  return Change{.value = std::min(1.0, 1.0 - explained_share(moments)),
                .error = 2.0 * relative_noise / std::sqrt(independent)};
}

/// By how much `before` is displaced against `now`, from all patches together.
cv::Point find_shift(const FacePrint& now, const FacePrint& before) {
  // The richest patches tell it best, and a few of them tell it well enough.
  constexpr std::size_t kEnough = 8;
  std::vector<std::pair<double, std::size_t>> richest;
  for (std::size_t i = 0; i < now.patches.size(); ++i) {
    richest.emplace_back(energy(now.patches[i].detail), i);
  }
  const std::size_t count = std::min(kEnough, richest.size());
  std::partial_sort(richest.begin(), richest.begin() + static_cast<std::ptrdiff_t>(count),
                    richest.end(), std::greater<>());
  constexpr int kPlaces = 2 * kMostShift + 1;
  cv::Mat likeness = cv::Mat::zeros(kPlaces, kPlaces, CV_32F);
  for (std::size_t i = 0; i < count; ++i) {
    const cv::Mat& old = before.patches[richest[i].second].detail;
    const cv::Mat& fresh = now.patches[richest[i].second].detail;
    cv::Rect searched = core_of(old);
    searched.x -= kMostShift;
    searched.y -= kMostShift;
    searched.width += 2 * kMostShift;
    searched.height += 2 * kMostShift;
    cv::Mat here;
    cv::matchTemplate(old(searched), fresh(core_of(fresh)), here, cv::TM_CCORR_NORMED);
    likeness += here;
  }
  cv::Point best;
  cv::minMaxLoc(likeness, nullptr, nullptr, nullptr, &best);
  return best - cv::Point(kMostShift, kMostShift);
}

/// The upper quartile over patches, of which enough must have content: chips and frost that a pass
/// left on a few patches do not make a new face, and tissue that changes slowly on most of them
/// does not make an old one.
class UpperQuartile {
 public:
  void add(const std::optional<Change>& patch) {
    ++patches_;
    if (!patch) return;
    values_.push_back(patch->value);
    variance_ += patch->error * patch->error;
  }
  std::optional<Change> get(std::size_t least_share) {
    if (values_.empty() || values_.size() * least_share < patches_) return std::nullopt;
    const auto quartile = values_.begin() + static_cast<std::ptrdiff_t>(3 * values_.size() / 4);
    std::nth_element(values_.begin(), quartile, values_.end());
    constexpr double kAgainstMean = 1.36;  // a quartile's error, of many normal values
    return Change{
        .value = std::max(0.0, *quartile),
        .error = kAgainstMean * std::sqrt(variance_) / static_cast<double>(values_.size())};
  }

 private:
  std::size_t patches_ = 0;
  std::vector<double> values_;
  double variance_ = 0.0;
};

}  // namespace

FaceChange measure_face_change(const FacePrint& now, const FacePrint& before,
                               const std::optional<BandNoise>& noise) {
  FaceChange change;
  const bool comparable = now.columns == before.columns && now.rows == before.rows &&
                          !now.patches.empty() &&
                          now.patches[0].detail.size() == before.patches[0].detail.size();
  if (!comparable) return change;

  const cv::Point shift = find_shift(now, before);
  std::vector<std::optional<Change>> patches(now.patches.size());
  cv::parallel_for_({0, static_cast<int>(patches.size())}, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const auto k = static_cast<std::size_t>(i);
      patches[k] = change_of_patch(now.patches[k], before.patches[k], shift, noise);
    }
  });

  UpperQuartile whole;
  std::vector<UpperQuartile> rows(static_cast<std::size_t>(now.rows));
  std::vector<UpperQuartile> columns(static_cast<std::size_t>(now.columns));
  for (std::size_t i = 0; i < patches.size(); ++i) {
    whole.add(patches[i]);
    rows[i / columns.size()].add(patches[i]);
    columns[i % columns.size()].add(patches[i]);
  }
  change.whole = whole.get(kWholeShare);
  for (UpperQuartile& row : rows) change.rows.push_back(row.get(kLineShare));
  for (UpperQuartile& column : columns) change.columns.push_back(column.get(kLineShare));
  return change;
}

}  // namespace biotomy::acquisition
