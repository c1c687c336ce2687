#include "acquisition/calibration/fitness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <opencv2/core.hpp>

namespace biotomy::acquisition {
namespace {

constexpr double kFull = 65535.0;
constexpr double kLeastBright = 0.05;  ///< below it, noise and rounding become the field
constexpr double kMostBright = 0.9;
constexpr double kMostClipped = 1e-4;
constexpr double kMostDark = 0.1;
constexpr double kLeastEven = 0.25;    ///< the darkest part of the frame, of the mean
constexpr double kMostPattern = 0.02;  ///< standard deviation within a block, of the block's mean
constexpr int kMostBlocks = 24;        ///< across and down
constexpr int kLeastBlock = 16;        ///< pixels; a smaller one may lie within a pattern

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
    return sentence("%.4f of the values are at full scale: shorten the exposure, or dim the lamp",
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
  double pattern = 0.0;  ///< median over blocks and colours of the deviation within
};

Evenness evenness_of(const cv::Mat& mean) {
  const cv::Scalar whole = cv::mean(mean);
  Evenness evenness;
  std::vector<double> patterns;
  const int down = std::clamp(mean.rows / kLeastBlock, 1, kMostBlocks);
  const int across = std::clamp(mean.cols / kLeastBlock, 1, kMostBlocks);
  for (int row = 0; row < down; ++row) {
    for (int column = 0; column < across; ++column) {
      const cv::Range rows(row * mean.rows / down, (row + 1) * mean.rows / down);
      const cv::Range columns(column * mean.cols / across, (column + 1) * mean.cols / across);
      cv::Scalar level;
      cv::Scalar deviation;
      cv::meanStdDev(mean(rows, columns), level, deviation);
      for (int c = 0; c < 3; ++c) {
        evenness.darkest = std::min(evenness.darkest, level[c] / whole[c]);
        if (level[c] > 0.0) patterns.push_back(deviation[c] / level[c]);
      }
    }
  }
  if (patterns.empty()) return evenness;
  const auto middle = patterns.begin() + static_cast<std::ptrdiff_t>(patterns.size() / 2);
  std::nth_element(patterns.begin(), middle, patterns.end());
  evenness.pattern = *middle;
  return evenness;
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
