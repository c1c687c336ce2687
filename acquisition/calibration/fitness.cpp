#include "acquisition/calibration/fitness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace biotomy::acquisition {
namespace {

constexpr double kFull = 65535.0;
constexpr double kLeastBright = 0.05;  ///< below it, noise and rounding become the field
constexpr double kMostBright = 0.9;
constexpr double kMostClipped = 1e-4;
constexpr double kMostDark = 0.1;
constexpr double kLeastEven = 0.25;  ///< the darkest part of the frame, of the mean
constexpr double kMostPattern = 0.02;
constexpr int kMostBlocks = 24;  ///< across and down

std::string sentence(const char* format, double value) {
  std::array<char, 300> text{};
  // NOLINTNEXTLINE(clang-diagnostic-format-nonliteral): from the literals below
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

double brightest(const cv::Scalar& colours) {
  return std::max({colours[0], colours[1], colours[2]}) / kFull;
}
double darkest(const cv::Scalar& colours) {
  return std::min({colours[0], colours[1], colours[2]}) / kFull;
}

std::optional<std::string> light_complaint(const cv::Mat& part, double clipped) {
  const cv::Scalar mean = cv::mean(part);
  if (clipped > kMostClipped) {
    return sentence("%.4f of the values are clipped: shorten the exposure, or dim the lamp",
                    clipped);
  }
  if (darkest(mean) < kLeastBright) {
    return sentence(
        "the darkest colour is at %.3f of full scale, below 0.05: is the lamp on, and something "
        "pale in view?",
        darkest(mean));
  }
  if (brightest(mean) > kMostBright) {
    return sentence(
        "the brightest colour is at %.3f of full scale, above 0.9: shorten the exposure",
        brightest(mean));
  }
  return std::nullopt;
}

struct Evenness {
  double darkest = 1.0;  ///< block, of the frame's mean, in the worst colour
  double pattern = 0.0;  ///< root mean square of the brightness' fine structure, of its mean
};

double darkest_block(const cv::Mat& mean) {
  cv::Mat blocks;
  cv::resize(mean, blocks, {std::min(mean.cols, kMostBlocks), std::min(mean.rows, kMostBlocks)},
             0.0, 0.0, cv::INTER_AREA);
  const cv::Scalar whole = cv::mean(mean);
  double darkest = 1.0;
  for (int y = 0; y < blocks.rows; ++y) {
    for (int x = 0; x < blocks.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        darkest = std::min(darkest, blocks.at<cv::Vec3w>(y, x)[c] / whole[c]);
      }
    }
  }
  return darkest;
}

/// Of second differences over 2 pixels to either side: light that falls off evenly has none.
double pattern_of(const cv::Mat& mean) {
  constexpr int kReach = 2;
  constexpr double kNoise = 6.0;  // the sum of the squared weights 1 -2 1
  cv::Mat brightness;
  cv::transform(mean, brightness, cv::Matx13f(0.25F, 0.5F, 0.25F));
  brightness.convertTo(brightness, CV_32F);
  if (brightness.cols <= 2 * kReach || brightness.rows <= 2 * kReach) return 0.0;
  double squares = 0.0;
  for (const bool along_x : {true, false}) {
    const cv::Mat lines = along_x ? brightness.t() : brightness;
    const int inner = lines.rows - 2 * kReach;
    const cv::Mat differences = lines.rowRange(0, inner) -
                                2.0 * lines.rowRange(kReach, kReach + inner) +
                                lines.rowRange(2 * kReach, lines.rows);
    squares = std::max(
        squares, differences.dot(differences) / kNoise / static_cast<double>(differences.total()));
  }
  return std::sqrt(squares) / cv::mean(brightness)[0];
}

Evenness evenness_of(const cv::Mat& mean) {
  return {darkest_block(mean), pattern_of(mean)};
}

}  // namespace

cv::Mat middle_half(const cv::Mat& image) {
  return image(cv::Rect(image.cols / 4, image.rows / 4, std::max(image.cols / 2, 1),
                        std::max(image.rows / 2, 1)));
}

std::optional<std::string> flat_complaint(const MeanFrame& frames) {
  const cv::Mat mean = frames.mean();
  if (auto complaint = light_complaint(mean, frames.clipped())) return complaint;
  const Evenness evenness = evenness_of(mean);
  if (evenness.darkest < kLeastEven) {
    return sentence(
        "a part of the frame has %.2f of the mean light, below 0.25: straighten the lamp, and let "
        "the surface fill the frame",
        evenness.darkest);
  }
  if (evenness.pattern > kMostPattern) {
    return sentence(
        "the surface has a pattern of %.3f of its brightness, above 0.02: take a blank one, or put "
        "it out of focus",
        evenness.pattern);
  }
  return std::nullopt;
}

std::optional<std::string> dark_complaint(const MeanFrame& frames) {
  const double level = brightest(cv::mean(frames.mean()));
  if (level <= kMostDark) return std::nullopt;
  return sentence("the mean is at %.3f of full scale, above 0.1: is there light beside the lamp?",
                  level);
}

std::optional<std::string> white_complaint(const MeanFrame& frames) {
  return light_complaint(middle_half(frames.mean()), frames.clipped());
}

}  // namespace biotomy::acquisition
