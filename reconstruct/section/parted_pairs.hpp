#pragma once

#include <cstddef>
#include <vector>

#include "reconstruct/bricks/pixel_places.hpp"

namespace biotomy::reconstruct {

/// Memory for the parted pairs of a row, so that all its pixels can be mixed alike. `Level` is
/// std::uint8_t or std::uint16_t.
template <typename Level>
class PartedPairs {
 public:
  /// Copies the two texels of each parted pair side by side, and lets `places` say that they lie
  /// there: until the next call they do.
  void join(PixelPlaces<Level>& places);

 private:
  std::vector<std::byte> texels_;
};

}  // namespace biotomy::reconstruct
