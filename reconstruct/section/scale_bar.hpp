#pragma once

#include <string>

namespace biotomy::reconstruct {

/// A bar that shows a length in a picture.
struct ScaleBar {
  double length = 0.0;  ///< micrometres; 1, 2 or 5 times a power of ten
  double pixels = 0.0;  ///< the same length in the picture
  std::string label;    ///< ASCII: "500 um", "2 mm"
};

/// The bar whose length is nearest, as a ratio, to a fifth of a picture of `width` pixels of
/// `pixel` micrometres, or to one pixel where that is more. It is not longer than the picture.
ScaleBar scale_bar(int width, double pixel);

}  // namespace biotomy::reconstruct
