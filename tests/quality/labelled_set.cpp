#include "tests/quality/labelled_set.hpp"

#include <cstddef>

namespace biotomy::tests {

std::vector<SequenceSettings> labelled_set(Seeds seeds, int sequences) {
  constexpr std::uint64_t kFirstTrainSeed = 1000;
  constexpr std::uint64_t kFirstTestSeed = 1300000;
  std::vector<SequenceSettings> set(static_cast<std::size_t>(sequences));
  for (std::size_t i = 0; i < set.size(); ++i) {
    SequenceSettings& s = set[i];
    s.seed = (seeds == Seeds::train ? kFirstTrainSeed : kFirstTestSeed) + 17 * i;
    switch (i % 6) {
      case 1:
        s.begins_at_layer = 8.0;
        s.end_layers = 12.0;
        break;
      case 2:
        s.ends_at_layer = s.layers - 6.0;
        s.end_layers = 14.0;
        break;
      case 3:
        s.layer_um = 60.0;
        s.depth_layers = 25.0;
        break;
      case 4:
        s.pixel_um = 5.0;
        s.detail_pixels = 2.5;
        s.depth_layers = 30.0;
        break;
      case 5:
        s.begins_at_layer = 4.0;
        s.ends_at_layer = s.layers - 2.0;
        s.end_layers = 0.5 * (s.ends_at_layer - s.begins_at_layer);
        break;
      default:
        break;
    }
  }
  return set;
}

}  // namespace biotomy::tests
