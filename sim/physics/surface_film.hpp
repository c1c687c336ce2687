#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

namespace biotomy::sim {

/// Rime on the face: patches of a whitish veil, wherever damp air met the cold block.
struct Frost {
  double share = 0;      ///< of the frame that it covers
  double opacity = 0.4;  ///< of the veil: 1 hides what is under it
};

/// Reflections of the lamp on ice or liquid: spots brighter than the sensor can show.
struct Glare {
  double share = 0;  ///< of the frame that they cover
};

/// What lies on the face or shines from it, beside debris: nothing by default.
struct SurfaceFilm {
  Frost frost{};
  Glare glare{};
};

/// Lays the film over a CV_32FC3 picture of the face, R, G, B in levels, in place. The same seed
/// gives the same patches and spots.
void lay_film(cv::Mat& picture, const SurfaceFilm& film, std::uint64_t seed);

}  // namespace biotomy::sim
