#include "acquisition/quality/sharpness_record.hpp"

#include <utility>

namespace biotomy::acquisition {

void SharpnessRecord::accept(Frame frame) {
  if (recent_.size() == kRemembered) recent_.erase(recent_.begin());
  recent_.push_back(expressed(std::move(frame)));
}

void SharpnessRecord::found_focus(std::int64_t layer, Frame peak) {
  peak_layer_ = layer;
  peak_ = expressed(std::move(peak));
}

void SharpnessRecord::know_noise(const CameraNoise& noise) {
  noise_ = noise;
  for (Frame& frame : recent_) frame = expressed(std::move(frame));
  peak_ = expressed(std::move(peak_));
}

SharpnessRecord::Frame SharpnessRecord::expressed(Frame frame) const {
  if (!noise_ || !frame) return frame;
  return std::make_shared<const FrameMeasures>(with_noise(*frame, *noise_));
}

std::optional<BandNoise> SharpnessRecord::noise_of_faces() const {
  return noise_ && !is_white(*noise_) ? noise_->face : std::nullopt;
}

}  // namespace biotomy::acquisition
