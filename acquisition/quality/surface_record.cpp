#include "acquisition/quality/surface_record.hpp"

#include <algorithm>
#include <utility>

#include "acquisition/quality/median.hpp"

namespace biotomy::acquisition {
void SurfaceRecord::accept(std::int64_t layer, std::shared_ptr<const SurfacePrint> surface,
                           const FrameLight& light, double arrived) {
  layer_ = layer;
  arrived_ = arrived;
  surface_ = std::move(surface);
  if (surface_ && surface_->colours) colours_.push_back(surface_->colours);
  if (colours_.size() > kRemembered) colours_.erase(colours_.begin());
  lights_.push_back(light);
  if (lights_.size() > kRemembered) lights_.pop_front();
  if (!light.casting) return;
  casting_ = light.casting;
  if (!first_casting_) first_casting_ = light.casting;
}

LightChange SurfaceRecord::last_light() const {
  return lights_.empty() ? LightChange{} : lights_.back().since_first;
}

LightChange SurfaceRecord::usual_light() const {
  LightChange usual;
  if (lights_.empty()) return usual;
  for (std::size_t c = 0; c < usual.colours.size(); ++c) {
    for (std::size_t term = 0; term < SmoothSurface::kTerms; ++term) {
      std::vector<double> values;
      for (const FrameLight& light : lights_) {
        values.push_back(light.since_first.colours[c].coefficients[term]);
      }
      usual.colours[c].coefficients[term] = median(std::move(values));
    }
  }
  return usual;
}

double SurfaceRecord::level_error() const {
  double most = 0.0;
  for (const FrameLight& light : lights_) most = std::max(most, light.measured.level_error);
  return most;
}

double SurfaceRecord::range_error() const {
  double most = 0.0;
  for (const FrameLight& light : lights_) most = std::max(most, light.measured.range_error);
  return most;
}

}  // namespace biotomy::acquisition
