#include "reconstruct/picture/rgb_picture.hpp"

#include <string>

#include "reconstruct/errors.hpp"

namespace biotomy::reconstruct {

void require_rgb_picture(const cv::Mat& picture) {
  if (picture.empty()) {
    throw InvalidRequest("the picture to be written has no pixels");
  }
  if (picture.dims != 2 || (picture.type() != CV_8UC3 && picture.type() != CV_16UC3)) {
    throw InvalidRequest("the picture to be written is of type " +
                         cv::typeToString(picture.type()) +
                         ": only 8 or 16 bits of R, G and B (CV_8UC3, CV_16UC3) can be written");
  }
}

}  // namespace biotomy::reconstruct
