#include "reconstruct/section/scale_bar.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace biotomy::reconstruct {
namespace {

constexpr double kShare = 0.2;      // of the picture's width
constexpr double kRounding = 1e-9;  // a picture as long as a bar has room for it
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
  const double room = width * pixel * (1.0 + kRounding);
  const double wanted = std::max(kShare * width, 1.0) * pixel;
  const int power = static_cast<int>(std::floor(std::log10(wanted)));
  double best = length_of(1.0, power);  // which is no more than wanted
  for (const double digit : {2.0, 5.0, 10.0}) {
    const double length = length_of(digit, power);
    if (length <= room && std::abs(std::log(length / wanted)) < std::abs(std::log(best / wanted))) {
      best = length;
    }
  }
  return {best, best / pixel, label_of(best)};
}

}  // namespace biotomy::reconstruct
