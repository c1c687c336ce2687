#include "sim/physics/face_tilt.hpp"

#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

namespace biotomy::sim {

namespace {

constexpr int kCells = 16;      // along each side
constexpr double kReach = 4.0;  // standard deviations of the blur that a cell looks beyond itself
constexpr int kLeastReach = 4;  // pixels

int part(int whole, int number) {
  return whole * number / kCells;
}

}  // namespace

void blur_tilted(cv::Mat& picture, const Lens& lens, double pixel_um, double defocus_um,
                 const FaceTilt& tilt) {
  if (tilt == FaceTilt{}) {
    blur(picture, blur_sigma_um(lens, defocus_um) / pixel_um);
    return;
  }
  const cv::Mat sharp = picture.clone();
  cv::parallel_for_({0, kCells * kCells}, [&](const cv::Range& cells) {
    for (int number = cells.start; number < cells.end; ++number) {
      const int column = number % kCells;
      const int row = number / kCells;
      const cv::Rect cell(cv::Point(part(picture.cols, column), part(picture.rows, row)),
                          cv::Point(part(picture.cols, column + 1), part(picture.rows, row + 1)));
      if (cell.empty()) continue;
      const double here_um = defocus_um + tilt.across_um * ((column + 0.5) / kCells - 0.5) +
                             tilt.down_um * ((row + 0.5) / kCells - 0.5);
      const double sigma = blur_sigma_um(lens, here_um) / pixel_um;
      const int reach = kLeastReach + static_cast<int>(std::ceil(kReach * sigma));
      const cv::Rect seen = cv::Rect(cell.x - reach, cell.y - reach, cell.width + 2 * reach,
                                     cell.height + 2 * reach) &
                            cv::Rect({0, 0}, picture.size());
      cv::Mat blurred = sharp(seen).clone();
      blur(blurred, sigma);
      blurred(cell - seen.tl()).copyTo(picture(cell));
    }
  });
}

}  // namespace biotomy::sim
