#include "firmware_bridge/camera/told_settings.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace biotomy::bridge {

namespace {

constexpr double kShare = 0.1;
constexpr double kExposureStep = 100.0;  // µs: the unit of USB Video Class cameras
constexpr double kLensStep = 0.05;       // dioptres

std::optional<std::string> compared(const char* what, double asked, std::optional<double> told,
                                    double tolerance) {
  if (!told || std::abs(*told - asked) <= tolerance) return std::nullopt;
  std::ostringstream text;
  text << what << " of " << *told << " instead of " << asked;
  return text.str();
}

}  // namespace

std::optional<std::string> difference(const CameraSettings& asked, const ToldSettings& told) {
  const auto exposure = static_cast<double>(asked.exposure.count());
  std::optional<double> told_exposure;
  if (told.exposure) told_exposure = static_cast<double>(told.exposure->count());
  if (auto text = compared("an exposure in us", exposure, told_exposure,
                           std::max(kExposureStep, kShare * exposure))) {
    return text;
  }
  if (auto text = compared("a gain", asked.gain, told.gain, kShare * asked.gain)) return text;
  if (auto text =
          compared("a gain of red", asked.red_gain, told.red_gain, kShare * asked.red_gain)) {
    return text;
  }
  if (auto text =
          compared("a gain of blue", asked.blue_gain, told.blue_gain, kShare * asked.blue_gain)) {
    return text;
  }
  if (!asked.lens_position) return std::nullopt;
  return compared("a lens position in dioptres", *asked.lens_position, told.lens_position,
                  kLensStep);
}

bool tells_all(const SettingsOffered& offered, const CameraSettings& asked,
               const ToldSettings& told) {
  const bool tells_lens = !offered.lens || !asked.lens_position || told.lens_position;
  return (!offered.exposure || told.exposure) && (!offered.gain || told.gain) &&
         (!offered.colour_gains || (told.red_gain && told.blue_gain)) && tells_lens;
}

}  // namespace biotomy::bridge
