#include "acquisition/quality/sharpness.hpp"

#include <opencv2/imgproc.hpp>

namespace biotomy::acquisition {

cv::Mat brightness_of(const cv::Mat& image) {
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_RGB2GRAY);
  cv::Mat brightness;
  grey.convertTo(brightness, CV_32F, image.depth() == CV_16U ? 1.0 / 65535.0 : 1.0 / 255.0);
  return brightness;
}

double sharpness_of_brightness(const cv::Mat& brightness) {
  if (brightness.empty()) return 0.0;
  const double mean = cv::mean(brightness)[0];
  if (mean <= 0.0) return 0.0;

  cv::Mat smooth;
  cv::GaussianBlur(brightness, smooth, cv::Size(7, 7), 1.0);
  cv::Mat gradient;
  double energy = 0.0;
  for (const bool along_x : {true, false}) {
    // Sobel with an aperture of 1 is the difference of the two neighbours: half of it is per pixel.
    cv::Sobel(smooth, gradient, CV_32F, along_x ? 1 : 0, along_x ? 0 : 1, 1, 0.5);
    energy += gradient.dot(gradient);
  }
  return energy / static_cast<double>(brightness.total()) / (mean * mean);
}

double sharpness(const cv::Mat& image) {
  if (image.empty()) return 0.0;
  return sharpness_of_brightness(brightness_of(image));
}

}  // namespace biotomy::acquisition
