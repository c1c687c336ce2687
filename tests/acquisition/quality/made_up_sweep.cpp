#include "tests/acquisition/quality/made_up_sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace biotomy::tests {
namespace {

/// Noise of waves from 2 to 64 pixels, of the same strength in each octave, as in tissue.
cv::Mat texture(cv::Size size, double contrast, cv::RNG& random) {
  cv::Mat sum = cv::Mat::zeros(size, CV_32FC1);
  for (int wave = 1; wave <= 32; wave *= 2) {
    cv::Mat octave(size.height / wave + 2, size.width / wave + 2, CV_32FC1);
    random.fill(octave, cv::RNG::NORMAL, 0.0, 1.0);
    cv::Mat whole;
    cv::resize(octave, whole, {octave.cols * wave, octave.rows * wave}, 0, 0, cv::INTER_CUBIC);
    sum += whole(cv::Rect({0, 0}, size));
  }
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(sum, mean, deviation);
  return (sum - mean[0]) * (contrast / deviation[0]);
}

cv::Point somewhere(cv::Size size, cv::RNG& random) {
  return {random.uniform(size.width / 8, 7 * size.width / 8),
          random.uniform(size.height / 8, 7 * size.height / 8)};
}

cv::Mat field_of(const MadeUpSweep& sweep, cv::RNG& random) {
  cv::Mat field(sweep.size, CV_32FC1, cv::Scalar(sweep.brightness));
  if (sweep.field == MadeUpSweep::Field::textured) {
    field += texture(sweep.size, sweep.contrast, random);
  }
  if (sweep.field == MadeUpSweep::Field::a_few_marks) {
    for (int mark = 0; mark < 4; ++mark) {
      cv::circle(field, somewhere(sweep.size, random), 3,
                 cv::Scalar(sweep.brightness + sweep.contrast), cv::FILLED);
    }
  }
  field = cv::max(field, 0.0);
  for (int spot = 0; spot < sweep.bright_spots; ++spot) {
    cv::circle(field, somewhere(sweep.size, random), static_cast<int>(sweep.spot_radius_px),
               cv::Scalar(sweep.spot_brightness), cv::FILLED);
  }
  return field;
}

/// A lens out of focus: the mean over a disc, with its rim softened to parts of a pixel.
cv::Mat defocused(const cv::Mat& sharp, double radius) {
  if (radius <= 0.0) return sharp.clone();
  const int reach = static_cast<int>(std::ceil(radius)) + 1;
  cv::Mat disc(2 * reach + 1, 2 * reach + 1, CV_32FC1);
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      disc.at<float>(y + reach, x + reach) =
          static_cast<float>(std::clamp(radius + 0.5 - std::hypot(x, y), 0.0, 1.0));
    }
  }
  disc /= cv::sum(disc)[0];
  cv::Mat blurred;
  cv::filter2D(sharp, blurred, -1, disc, {-1, -1}, 0.0, cv::BORDER_REFLECT);
  return blurred;
}

}  // namespace

cv::Mat MadeUpSweep::frame(std::size_t number) const {
  cv::RNG random(seed);
  const cv::Mat scene = field_of(*this, random);
  cv::Mat seen = defocused(scene, blur_px[number]);
  if (deep_part > 0.0) {
    const auto earlier = static_cast<std::size_t>(
        std::clamp<int>(static_cast<int>(number) - deep_frames, 0, static_cast<int>(frames()) - 1));
    const int left = static_cast<int>((1.0 - deep_part) * size.width);
    const cv::Rect deep(left, 0, size.width - left, size.height);
    defocused(scene, blur_px[earlier])(deep).copyTo(seen(deep));
  }
  if (breathing != 0.0) {
    const double scale = 1.0 + breathing * static_cast<double>(number);
    const cv::Mat about_the_centre = cv::getRotationMatrix2D(
        {static_cast<float>(size.width) / 2, static_cast<float>(size.height) / 2}, 0.0, scale);
    cv::warpAffine(seen, seen, about_the_centre, size, cv::INTER_CUBIC, cv::BORDER_REFLECT);
  }
  if (!exposure.empty()) seen *= exposure[number];

  cv::RNG noise_of_frame(seed * 1000 + number + 1);
  const std::array<double, 3> tint = grey ? std::array{1.0, 1.0, 1.0} : std::array{1.0, 0.8, 0.7};
  std::array<cv::Mat, 3> channels;
  for (std::size_t c = 0; c < 3; ++c) {
    if (grey && c > 0) {
      channels[c] = channels[0];
      continue;
    }
    cv::Mat grain(size, CV_32FC1);
    noise_of_frame.fill(grain, cv::RNG::NORMAL, 0.0,
                        noise_gain.empty() ? noise : noise * noise_gain[number]);
    const cv::Mat light = seen * tint[c] + grain;
    const bool wide = type == CV_16UC3;
    light.convertTo(channels[c], wide ? CV_16U : CV_8U, wide ? 65535.0 : 255.0);
  }
  cv::Mat rgb;
  cv::merge(channels.data(), channels.size(), rgb);
  return rgb;
}

}  // namespace biotomy::tests
