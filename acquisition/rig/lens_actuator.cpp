#include "acquisition/rig/lens_actuator.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace biotomy::acquisition {
namespace {

constexpr double kMicrometresOfDioptre = 1e6;
constexpr double kFarthestDioptres = 0.1;

}  // namespace

double dioptres_at(bridge::Micrometres distance) {
  return kMicrometresOfDioptre / distance.value;
}

bridge::Micrometres distance_of(double dioptres) {
  return {kMicrometresOfDioptre / dioptres};
}

bridge::AxisLimits lens_limits(const bridge::LensRange& lens) {
  return {distance_of(lens.nearest), distance_of(std::max(lens.farthest, kFarthestDioptres))};
}

LensActuator::LensActuator(bridge::Camera& camera, const bridge::CameraSettings& settings,
                           bridge::LensRange lens, Worker& worker)
    : camera_(camera), settings_(settings), lens_(lens), worker_(worker) {}

void LensActuator::move_to(bridge::Micrometres target, TimePoint) {
  // Rounding may lead a hair beyond the range.
  settings_.lens_position = std::clamp(dioptres_at(target), lens_.farthest, lens_.nearest);
  applied_ =
      run_on(worker_, [camera = &camera_, settings = settings_] { camera->apply(settings); });
}

bool LensActuator::settled(const bridge::StageStatus&, TimePoint) {
  if (!is_ready(applied_)) return false;
  applied_.get();
  return true;
}

std::optional<bridge::Micrometres> LensActuator::reported(const bridge::StageStatus&) const {
  return std::nullopt;
}

std::string LensActuator::describe(bridge::Micrometres position) const {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.3f dioptres", dioptres_at(position));
  return text.data();
}

}  // namespace biotomy::acquisition
