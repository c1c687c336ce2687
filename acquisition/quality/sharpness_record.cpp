#include "acquisition/quality/sharpness_record.hpp"

#include <utility>

namespace biotomy::acquisition {

void SharpnessRecord::accept(Frame frame) {
  if (recent_.size() == kRemembered) recent_.erase(recent_.begin());
  recent_.push_back(std::move(frame));
}

void SharpnessRecord::found_focus(std::int64_t layer, Frame peak) {
  peak_layer_ = layer;
  peak_ = std::move(peak);
}

}  // namespace biotomy::acquisition
