#include "acquisition/calibration/field_correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

#include "acquisition/quality/clipping_levels.hpp"

namespace biotomy::acquisition {
namespace {

constexpr int kGainBits = 14;
constexpr double kUnity = 1 << kGainBits;
constexpr double kMostGain = 65535.0;
constexpr double kLevel = 256.0;  ///< of 8 bits, in the dark field
constexpr double kSixteenBitsALevel = 257.0;

// The loops below are of 16-bit operations alone, which a compiler makes vectors of.

std::uint16_t less(std::uint16_t value, std::uint16_t dark) {
  return value > dark ? static_cast<std::uint16_t>(value - dark) : std::uint16_t{0};
}

std::uint16_t upper_half(std::uint16_t a, std::uint16_t b) {
  return static_cast<std::uint16_t>((static_cast<std::uint32_t>(a) * b) >> 16U);
}

template <bool kDark>
void correct_row(std::uint8_t* values, const std::uint16_t* gain, const std::uint16_t* dark,
                 int count) {
  for (int i = 0; i < count; ++i) {
    auto light = static_cast<std::uint16_t>(values[i] << 8U);
    if constexpr (kDark) light = less(light, dark[i]);
    const std::uint16_t level = upper_half(light, gain[i]);  // in 64ths
    const auto rounded = static_cast<std::uint16_t>((level >> 6U) + ((level >> 5U) & 1U));
    const std::uint16_t kept = std::min<std::uint16_t>(rounded, 255);
    values[i] = values[i] == 255 ? std::uint8_t{255} : static_cast<std::uint8_t>(kept);
  }
}

template <bool kDark>
void correct_row(std::uint16_t* values, const std::uint16_t* gain, const std::uint16_t* dark,
                 int count) {
  constexpr std::uint16_t kFull = 65535;
  for (int i = 0; i < count; ++i) {
    std::uint16_t light = values[i];
    if constexpr (kDark) light = less(light, dark[i]);
    const std::uint16_t upper = upper_half(light, gain[i]);
    const auto lower = static_cast<std::uint16_t>(light * gain[i]);
    const auto level = static_cast<std::uint16_t>((upper << 2U) | (lower >> 14U));
    const auto rounded = static_cast<std::uint16_t>(level + ((lower >> 13U) & 1U));
    const bool full = values[i] == kFull || upper >= (1U << kGainBits) || rounded < level;
    values[i] = full ? kFull : rounded;
  }
}

/// What is clipped, at full scale: where it is corrected it would smear, and no longer pile up.
template <typename Sample>
void saturate_row(Sample* values, const Sample* levels, int count) {
  constexpr Sample kFull = std::numeric_limits<Sample>::max();
  for (int i = 0; i < count; ++i) values[i] = values[i] >= levels[i] ? kFull : values[i];
}

/// By way of the light, of which there is as much at a time as stays in the processor's cache.
template <typename Sample, bool kDark>
void correct_srgb_row(Sample* values, const std::uint16_t* gain, const std::uint16_t* dark,
                      int count) {
  constexpr int kMost = 2048;
  // Pointers of its own: bytes that are written could be the tables' for all the compiler knows.
  const std::uint16_t* light_of_value = bridge::srgb_tables<Sample>().light.data();
  const Sample* value_of_light = bridge::srgb_tables<Sample>().value.data();
  std::array<std::uint16_t, kMost> light{};
  for (int first = 0; first < count; first += kMost) {
    const int part = std::min(kMost, count - first);
    for (int i = 0; i < part; ++i) light[i] = light_of_value[values[first + i]];
    correct_row<kDark>(light.data(), gain + first, kDark ? dark + first : nullptr, part);
    for (int i = 0; i < part; ++i) values[first + i] = value_of_light[light[i]];
  }
}

template <typename Sample, bool kDark>
void correct_row(bridge::Transfer transfer, Sample* values, const std::uint16_t* gain,
                 const std::uint16_t* dark, int count) {
  if (transfer == bridge::Transfer::srgb) {
    correct_srgb_row<Sample, kDark>(values, gain, dark, count);
  } else {
    correct_row<kDark>(values, gain, dark, count);
  }
}

/// The levels of a row's values.
template <typename Sample>
std::vector<Sample> row_of(const ClippingLevels& levels, int width) {
  std::vector<Sample> row;
  row.reserve(levels.size() * static_cast<std::size_t>(width));
  for (int x = 0; x < width; ++x) {
    for (const int level : levels) row.push_back(static_cast<Sample>(level));
  }
  return row;
}

template <typename Sample>
void correct(cv::Mat& image, bridge::Transfer transfer, const cv::Mat& gain, const cv::Mat& dark) {
  const std::vector<Sample> levels = row_of<Sample>(clipping_levels(image), image.cols);
  cv::parallel_for_({0, image.rows}, [&](const cv::Range& rows) {
    const int count = 3 * image.cols;
    for (int y = rows.start; y < rows.end; ++y) {
      auto* values = image.ptr<Sample>(y);
      saturate_row(values, levels.data(), count);
      const auto* gains = gain.ptr<std::uint16_t>(y);
      if (dark.empty()) {
        correct_row<Sample, false>(transfer, values, gains, nullptr, count);
      } else {
        correct_row<Sample, true>(transfer, values, gains, dark.ptr<std::uint16_t>(y), count);
      }
    }
  });
}

}  // namespace

FieldCorrection::FieldCorrection(const cv::Mat& flat, const cv::Mat& dark, int type,
                                 bridge::Transfer transfer)
    : type_(type), transfer_(transfer), size_(flat.empty() ? dark.size() : flat.size()) {
  gain_ = cv::Mat(size_, CV_16UC3, cv::Scalar::all(kUnity));
  if (!flat.empty()) {
    cv::Mat light;
    flat.convertTo(light, CV_32F);
    if (!dark.empty()) cv::subtract(light, dark, light, cv::noArray(), CV_32F);
    const cv::Scalar mean = cv::mean(light);
    for (int y = 0; y < size_.height; ++y) {
      const auto* got = light.ptr<float>(y);
      auto* gain = gain_.ptr<std::uint16_t>(y);
      for (int i = 0; i < 3 * size_.width; ++i) {
        const double whole = mean[i % 3];
        const double part = std::max(static_cast<double>(got[i]), kLeastLight * whole);
        gain[i] = static_cast<std::uint16_t>(
            part > 0.0 ? std::min(std::round(kUnity * whole / part), kMostGain) : kUnity);
      }
    }
  }
  if (!dark.empty()) {
    const bool is_of_levels = type == CV_8UC3 && transfer == bridge::Transfer::linear;
    dark.convertTo(dark_, CV_16U, is_of_levels ? kLevel / kSixteenBitsALevel : 1.0);
  }
}

void FieldCorrection::apply(cv::Mat& image) const {
  CV_Assert(image.size() == size_ && image.type() == type_);
  if (type_ == CV_16UC3) {
    correct<std::uint16_t>(image, transfer_, gain_, dark_);
  } else {
    correct<std::uint8_t>(image, transfer_, gain_, dark_);
  }
}

}  // namespace biotomy::acquisition
