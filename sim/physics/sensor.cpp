#include "sim/physics/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <opencv2/core.hpp>

#include "sim/phantom/gradient_noise.hpp"
#include "sim/physics/colour_mosaic.hpp"

namespace biotomy::sim {

namespace {

// Noise is drawn once into a table; each row of each frame starts reading it somewhere else.
constexpr std::size_t kNoiseTable = std::size_t{1} << 20U;
constexpr std::uint64_t kNoiseStream = 0x6e6f6973;

/// Squares of the distance from the middle, 0.5 at both ends: two of them add up to 1 in a corner.
std::vector<float> half_squares(int size, double loss) {
  std::vector<float> values(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) {
    const double t = (2.0 * i + 1.0) / size - 1.0;
    values[static_cast<std::size_t>(i)] = static_cast<float>(0.5 * loss * t * t);
  }
  return values;
}

/// Box & Muller, Annals of Mathematical Statistics 29 (1958) 610.
std::vector<float> standard_normal(std::uint64_t seed) {
  std::vector<float> values(kNoiseTable);
  for (std::size_t i = 0; i < kNoiseTable; i += 2) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - mixed_fraction(seed, i)));
    const double angle = 2.0 * std::numbers::pi * mixed_fraction(seed, i + 1);
    values[i] = static_cast<float>(radius * std::cos(angle));
    values[i + 1] = static_cast<float>(radius * std::sin(angle));
  }
  return values;
}

/// What is the same for all pixels of a frame.
struct Response {
  float channel[3];       ///< level for a level of light
  float photon_variance;  ///< for a level of output
  float read_variance;
  float to_number;  ///< the pixel's number for a level: 1 or 257
};

template <typename Number>
void expose_row(const float* light, int width, const std::vector<float>& across, float light_share,
                const Response& response, const float* noise, Number* out) {
  constexpr auto kMost = static_cast<float>(std::numeric_limits<Number>::max());
  for (int x = 0; x < width; ++x) {
    const float share = light_share - across[static_cast<std::size_t>(x)];
    for (int c = 0; c < 3; ++c) {
      const int i = 3 * x + c;
      const float level = std::max(light[i] * share * response.channel[c], 0.0F);
      const float deviation = std::sqrt(level * response.photon_variance + response.read_variance);
      const float number = (level + noise[i] * deviation) * response.to_number + 0.5F;
      out[i] = static_cast<Number>(std::clamp(number, 0.0F, kMost));
    }
  }
}

}  // namespace

Sensor::Sensor(std::uint64_t seed, int width, int height, const SensorSettings& settings)
    : seed_(seed ^ kNoiseStream),
      settings_(settings),
      across_(half_squares(width, settings.vignetting)),
      down_(half_squares(height, settings.vignetting)),
      noise_(standard_normal(seed_)) {}

cv::Mat Sensor::expose(const cv::Mat& light, double lamp, const ExposureSettings& exposure,
                       std::uint64_t frame) const {
  const double amount = exposure.exposure_us / settings_.nominal_exposure_us * exposure.gain *
                        std::max(lamp, settings_.stray_light);
  const Response response{
      {static_cast<float>(amount * exposure.red_gain), static_cast<float>(amount),
       static_cast<float>(amount * exposure.blue_gain)},
      static_cast<float>(255.0 * exposure.gain / settings_.photons_at_white),
      static_cast<float>(std::pow(settings_.read_noise_levels * exposure.gain, 2)),
      settings_.bits == 16 ? 257.0F : 1.0F};
  cv::Mat photograph(light.size(), settings_.bits == 16 ? CV_16UC3 : CV_8UC3);
  const std::size_t places = kNoiseTable - static_cast<std::size_t>(3 * light.cols);
  cv::parallel_for_({0, light.rows}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      const auto row =
          frame * static_cast<std::uint64_t>(light.rows) + static_cast<std::uint64_t>(y);
      const float* noise = noise_.data() + mixed_bits(seed_ + 1, row) % places;
      const float share = 1.0F - down_[static_cast<std::size_t>(y)];
      if (settings_.bits == 16) {
        expose_row(light.ptr<float>(y), light.cols, across_, share, response, noise,
                   photograph.ptr<std::uint16_t>(y));
      } else {
        expose_row(light.ptr<float>(y), light.cols, across_, share, response, noise,
                   photograph.ptr<std::uint8_t>(y));
      }
    }
  });
  if (settings_.mosaic) interpolate_mosaic(photograph);
  return photograph;
}

}  // namespace biotomy::sim
