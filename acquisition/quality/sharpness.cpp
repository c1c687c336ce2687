#include "acquisition/quality/sharpness.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

namespace biotomy::acquisition {

namespace {

/// Rows that are worked on together: what is made of them on the way stays in a core's cache,
/// where planes of a whole photograph would be fetched from memory at each step.
constexpr int kBand = 64;

cv::Range band(int number, int rows) {
  return {number * kBand, std::min((number + 1) * kBand, rows)};
}

int bands_of(int rows) {
  return (rows + kBand - 1) / kBand;
}

/// The energy of the gradient, summed over a band of rows. OpenCV's filters look at the rows beside
/// the band where there are any.
double gradient_energy(const cv::Mat& brightness, const cv::Range& rows) {
  // The differences along y need one smooth row more on either side.
  const cv::Range wider(std::max(rows.start - 1, 0), std::min(rows.end + 1, brightness.rows));
  cv::Mat smooth;
  cv::GaussianBlur(brightness.rowRange(wider), smooth, cv::Size(7, 7), 1.0);
  const cv::Mat inner = smooth.rowRange(rows.start - wider.start, rows.end - wider.start);
  cv::Mat gradient;
  double energy = 0.0;
  for (const bool along_x : {true, false}) {
    // Sobel with an aperture of 1 is the difference of the two neighbours: half of it is per pixel.
    cv::Sobel(inner, gradient, CV_32F, along_x ? 1 : 0, along_x ? 0 : 1, 1, 0.5);
    energy += gradient.dot(gradient);
  }
  return energy;
}

}  // namespace

cv::Mat brightness_of(const cv::Mat& image) {
  cv::Mat brightness(image.size(), CV_32F);
  const double scale = image.depth() == CV_16U ? 1.0 / 65535.0 : 1.0 / 255.0;
  cv::parallel_for_({0, bands_of(image.rows)}, [&](const cv::Range& numbers) {
    cv::Mat grey;
    for (int number = numbers.start; number < numbers.end; ++number) {
      const cv::Range rows = band(number, image.rows);
      cv::cvtColor(image.rowRange(rows), grey, cv::COLOR_RGB2GRAY);
      grey.convertTo(brightness.rowRange(rows), CV_32F, scale);
    }
  });
  return brightness;
}

double sharpness_of_brightness(const cv::Mat& brightness) {
  if (brightness.empty()) return 0.0;
  const double mean = cv::mean(brightness)[0];
  if (mean <= 0.0) return 0.0;

  // Summed in the order of the bands: the same frame has the same sharpness, whatever the threads.
  std::vector<double> energies(static_cast<std::size_t>(bands_of(brightness.rows)));
  cv::parallel_for_({0, bands_of(brightness.rows)}, [&](const cv::Range& numbers) {
    for (int number = numbers.start; number < numbers.end; ++number) {
      energies[static_cast<std::size_t>(number)] =
          gradient_energy(brightness, band(number, brightness.rows));
    }
  });
  const double energy = std::accumulate(energies.begin(), energies.end(), 0.0);
  return energy / static_cast<double>(brightness.total()) / (mean * mean);
}

double sharpness(const cv::Mat& image) {
  if (image.empty()) return 0.0;
  return sharpness_of_brightness(brightness_of(image));
}

}  // namespace biotomy::acquisition
