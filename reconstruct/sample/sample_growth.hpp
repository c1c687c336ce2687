#pragma once

#include <functional>
#include <vector>

#include "reconstruct/sample/layer_hashes.hpp"

namespace biotomy::reconstruct {

/// What those who verify a sample ask while a program may be adding layers to it. What they see of
/// it is not all of one moment: what looks wrong is looked at once more before it is told. Nobody
/// adds anything unless these say otherwise.
struct SampleGrowth {
  /// Whether somebody works on the sample, or has since the verification began.
  std::function<bool()> is_seen = [] { return false; };
  /// The records of the layers as they are now. Asked for only when growth is seen.
  std::function<std::vector<LayerHash>()> records = [] { return std::vector<LayerHash>(); };
  /// Waits a moment for what is being added now. False when nobody is adding anything, or when that
  /// has been waited for long enough.
  std::function<bool()> wait = [] { return false; };
};

}  // namespace biotomy::reconstruct
