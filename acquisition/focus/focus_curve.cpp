#include "acquisition/focus/focus_curve.hpp"

#include <algorithm>
#include <cmath>

namespace biotomy::acquisition {

std::vector<MeasuredPoint> focus_curve(std::span<const Detail> along_the_bracket) {
  constexpr double kLeastShare = 1e-3;  // what is left when noise is taken out may be below zero
  double most = 0.0;
  for (const Detail& detail : along_the_bracket) most = std::max(most, detail.energy);
  std::vector<MeasuredPoint> curve;
  if (most <= 0.0) return curve;
  for (const Detail& detail : along_the_bracket) {
    const double share = std::max(detail.energy / most, kLeastShare);
    curve.push_back({.x = static_cast<double>(curve.size()),
                     .y = std::log(share * most),
                     .error = detail.error / (share * most),
                     .weight = share * share});
  }
  return curve;
}

}  // namespace biotomy::acquisition
