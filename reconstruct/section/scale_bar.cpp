#include "reconstruct/section/scale_bar.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace biotomy::reconstruct {
namespace {

constexpr double kShare = 0.2;  // of the picture's width
constexpr double kMicrometresPerMillimetre = 1000.0;

/// `digit` · 10^`power`; whole powers of ten are exact, their reciprocals need a division.
double length_of(double digit, int power) {
  return power < 0 ? digit / std::pow(10.0, -power) : digit * std::pow(10.0, power);
}

std::string label_of(double micrometres) {
  const bool large = micrometres >= kMicrometresPerMillimetre;
  std::ostringstream text;
  text << (large ? micrometres / kMicrometresPerMillimetre : micrometres)
       << (large ? " mm" : " um");
  return text.str();
}

}  // namespace

ScaleBar scale_bar(int width, double pixel) {
  const double wanted = kShare * width * pixel;
  const int power = static_cast<int>(std::floor(std::log10(wanted)));
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const double digit : {1.0, 2.0, 5.0, 10.0}) {
    const double length = length_of(digit, power);
    const double distance = std::abs(std::log(length / wanted));
    if (distance < least) {
      least = distance;
      best = length;
    }
  }
  return {best, std::max(1, static_cast<int>(std::lround(best / pixel))), label_of(best)};
}

}  // namespace biotomy::reconstruct
