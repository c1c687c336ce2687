#pragma once

#include <string>

namespace biotomy::reconstruct {

/// What a picture's file says of it beside the pixels.
struct PictureNotes {
  double pixel = 0.0;       ///< the side of a pixel, micrometres; 0: not said
  std::string title;        ///< UTF-8; the sample's name
  std::string description;  ///< ASCII; JSON for the programs that will read it
};

}  // namespace biotomy::reconstruct
