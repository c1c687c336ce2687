#include "sim/physics/lamp_field.hpp"

#include <opencv2/core.hpp>

namespace biotomy::sim {

bool LampField::is_even() const {
  return *this == LampField{};
}

void light_up(cv::Mat& picture, const LampField& field) {
  // From -0.5 at one edge of the picture to 0.5 at the other.
  const auto place = [](int pixel, int size) {
    return (static_cast<double>(pixel) + 0.5) / size - 0.5;
  };
  cv::parallel_for_({0, picture.rows}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      auto* pixels = picture.ptr<cv::Vec3f>(y);
      const double row = 1.0 + field.slope_y * place(y, picture.rows);
      for (int x = 0; x < picture.cols; ++x) {
        const double here = row + field.slope_x * place(x, picture.cols);
        for (int c = 0; c < 3; ++c) {
          pixels[x][c] *= static_cast<float>(here * field.colour[static_cast<std::size_t>(c)]);
        }
      }
    }
  });
}

}  // namespace biotomy::sim
