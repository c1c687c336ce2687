#include "acquisition/quality/face_print.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace biotomy::acquisition {
namespace {

constexpr int kMostPatches = 8;  // along each side
constexpr int kLeastCore = 12;   // pixels of the half resolution
constexpr double kFine = 1.0;    // standard deviations of the band's two Gaussians
constexpr double kBroad = 4.0;
constexpr int kFineWindow = 7;  // three standard deviations to each side
constexpr int kBroadWindow = 25;

/// Brightness of one pixel, four times over; green counts twice, as in the eye and on the sensor.
template <typename Value>
int brightness(const Value* pixel) {
  return pixel[0] + 2 * pixel[1] + pixel[2];
}

template <typename Value>
void part_diagonals(const cv::Mat& image, const cv::Rect& place, cv::Mat& detail, cv::Mat& noise) {
  // Of four pixels, each four times over.
  constexpr float kScale = 1.0F / (16.0F * static_cast<float>(std::numeric_limits<Value>::max()));
  for (int y = 0; y < place.height; ++y) {
    const auto* upper = image.ptr<Value>(2 * (place.y + y)) + 6 * place.x;
    const auto* lower = image.ptr<Value>(2 * (place.y + y) + 1) + 6 * place.x;
    auto* detail_row = detail.ptr<float>(y);
    auto* noise_row = noise.ptr<float>(y);
    for (int x = 0; x < place.width; ++x) {
      const int falling = brightness(upper + 6 * x) + brightness(lower + 6 * x + 3);
      const int rising = brightness(upper + 6 * x + 3) + brightness(lower + 6 * x);
      detail_row[x] = kScale * static_cast<float>(falling + rising);
      noise_row[x] = kScale * static_cast<float>(falling - rising);
    }
  }
}

/// The part `index` of `count` along an axis of `length`, as begin and size, not longer than a
/// core.
std::pair<int, int> core_along(int index, int count, int length) {
  const int begin = index * length / count;
  const int end = (index + 1) * length / count;
  const int size = std::min(end - begin, FacePrint::kMostCore);
  return {begin + (end - begin - size) / 2, size};
}

FacePrint::Patch take_patch(const cv::Mat& image, const cv::Size& half, const cv::Rect& core) {
  const auto grown = [](const cv::Rect& rect, int by) {
    return cv::Rect(rect.x - by, rect.y - by, rect.width + 2 * by, rect.height + 2 * by);
  };
  const cv::Rect kept = grown(core, FacePrint::kReach);
  const cv::Rect looked_at = grown(kept, kBroadWindow / 2) & cv::Rect({0, 0}, half);
  cv::Mat detail(looked_at.size(), CV_32F);
  cv::Mat noise(looked_at.size(), CV_32F);
  if (image.depth() == CV_16U) {
    part_diagonals<std::uint16_t>(image, looked_at, detail, noise);
  } else {
    part_diagonals<std::uint8_t>(image, looked_at, detail, noise);
  }
  const cv::Rect inside(kept.tl() - looked_at.tl(), kept.size());
  return {print_band(detail, inside), print_band(noise, inside), cv::mean(detail)[0]};
}

}  // namespace

cv::Mat print_band(const cv::Mat& half, const cv::Rect& wanted) {
  cv::Mat fine;
  cv::Mat broad;
  cv::GaussianBlur(half, fine, {kFineWindow, kFineWindow}, kFine);
  cv::GaussianBlur(half, broad, {kBroadWindow, kBroadWindow}, kBroad);
  return fine(wanted) - broad(wanted);
}

std::optional<double> print_energy(const BrightnessPlane& plane) {
  BrightnessPlane half;
  halve(plane, half);
  const cv::Mat picture(half.height, half.width, CV_32FC1, half.values.data());
  constexpr int kMargin = kBroadWindow / 2;
  const cv::Rect inner(kMargin, kMargin, half.width - 2 * kMargin, half.height - 2 * kMargin);
  if (inner.width < 1 || inner.height < 1) return std::nullopt;
  const cv::Mat detail = print_band(picture, inner);
  const double energy = detail.dot(detail) / inner.area();
  return std::isfinite(energy) ? std::optional(energy) : std::nullopt;
}

FacePrint take_face_print(const cv::Mat& image) {
  FacePrint print;
  print.frame_rows = std::make_shared<const FrameRows>(rows_of(image));
  const cv::Size half(image.cols / 2, image.rows / 2);
  // What the filters make up beyond the frame's border would not move with the face. Small frames
  // can't spare as much.
  constexpr int kSmall = 16;
  const int margin =
      FacePrint::kReach + std::min(kBroadWindow / 2, std::min(half.width, half.height) / kSmall);
  const cv::Size inner(half.width - 2 * margin, half.height - 2 * margin);
  if (inner.width < kLeastCore || inner.height < kLeastCore) return print;

  print.columns = std::min(inner.width / kLeastCore, kMostPatches);
  print.rows = std::min(inner.height / kLeastCore, kMostPatches);
  print.patches.resize(static_cast<std::size_t>(print.columns * print.rows));
  cv::parallel_for_({0, print.columns * print.rows}, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const auto [x, width] = core_along(i % print.columns, print.columns, inner.width);
      const auto [y, height] = core_along(i / print.columns, print.rows, inner.height);
      const cv::Rect core(margin + x, margin + y, width, height);
      print.patches[static_cast<std::size_t>(i)] = take_patch(image, half, core);
    }
  });
  return print;
}

}  // namespace biotomy::acquisition
