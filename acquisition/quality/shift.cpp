#include "acquisition/quality/shift.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

namespace biotomy::acquisition {
namespace {

constexpr int kScale = 2;       ///< pixels of the frame along a side of a patch's pixel
constexpr int kMostSide = 192;  ///< of a patch, pixels of the frame
constexpr int kLeastSide = 64;
constexpr int kPatchesAlong = 5;  ///< a side of the frame, both corners included
constexpr double kLeastPeak = 0.05;
constexpr double kAlone = 2.0;  ///< the highest peak against the next
constexpr int kPeakReach = 2;   ///< pixels of a patch that belong to a peak

cv::Mat take_patch(const cv::Mat& image, const cv::Rect& place) {
  cv::Mat small;
  cv::resize(image(place), small, place.size() / kScale, 0.0, 0.0, cv::INTER_AREA);
  cv::Mat grey;
  cv::cvtColor(small, grey, cv::COLOR_RGB2GRAY);
  cv::Mat patch;
  grey.convertTo(patch, CV_32F, image.depth() == CV_16U ? 1.0 / 65535.0 : 1.0 / 255.0);
  return patch;
}

std::vector<cv::Rect> border_places(cv::Size frame) {
  const int side =
      std::min(std::min(frame.width, frame.height) / 3 / kLeastSide * kLeastSide, kMostSide);
  if (side < kLeastSide) return {};
  const cv::Size room(frame.width - side, frame.height - side);
  constexpr int kLast = kPatchesAlong - 1;
  std::vector<cv::Rect> places;
  for (int row = 0; row <= kLast; ++row) {
    for (int column = 0; column <= kLast; ++column) {
      if (row % kLast != 0 && column % kLast != 0) continue;
      places.emplace_back(room.width * column / kLast, room.height * row / kLast, side, side);
    }
  }
  return places;
}

/// Without its mean, which would make an edge of the window.
cv::Mat spectrum(const cv::Mat& patch, const cv::Mat& window) {
  const cv::Mat level = patch - cv::mean(patch)[0];
  cv::Mat result;
  cv::dft(level.mul(window), result, cv::DFT_COMPLEX_OUTPUT);
  return result;
}

/// The phases by which the frequencies of one patch are ahead of the other's, CV_32FC2.
cv::Mat phases(const cv::Mat& now, const cv::Mat& before, const cv::Mat& window) {
  cv::Mat product;
  cv::mulSpectrums(spectrum(now, window), spectrum(before, window), product, 0, true);
  for (int y = 0; y < product.rows; ++y) {
    auto* row = product.ptr<cv::Vec2f>(y);
    for (int x = 0; x < product.cols; ++x) {
      const float size = std::hypot(row[x][0], row[x][1]);
      row[x] = size > 0.0F ? row[x] * (1.0F / size) : cv::Vec2f(0.0F, 0.0F);
    }
  }
  return product;
}

/// A correlation that goes on at its other side where it ends.
class Correlation {
 public:
  explicit Correlation(const cv::Mat& values) : values_(values) {
    cv::minMaxLoc(values_, nullptr, &height_, nullptr, &peak_);
  }

  double height() const { return height_; }

  /// The highest value that does not belong to the peak.
  double next_height() const {
    double next = 0.0;
    for (int y = 0; y < values_.rows; ++y) {
      for (int x = 0; x < values_.cols; ++x) {
        const bool of_peak = std::abs(around(x - peak_.x, values_.cols)) <= kPeakReach &&
                             std::abs(around(y - peak_.y, values_.rows)) <= kPeakReach;
        if (!of_peak) next = std::max(next, at(x, y));
      }
    }
    return next;
  }

  cv::Point2d place() const {
    const double dx = top(at(peak_.x - 1, peak_.y), height_, at(peak_.x + 1, peak_.y));
    const double dy = top(at(peak_.x, peak_.y - 1), height_, at(peak_.x, peak_.y + 1));
    return {around(peak_.x, values_.cols) + dx, around(peak_.y, values_.rows) + dy};
  }

 private:
  double at(int x, int y) const {
    return static_cast<double>(
        values_.at<float>((y + values_.rows) % values_.rows, (x + values_.cols) % values_.cols));
  }
  static int around(int index, int count) {
    const int within = (index + count) % count;
    return within > count / 2 ? within - count : within;
  }
  /// Where a parabola through three values has its top, of the middle one.
  static double top(double left, double middle, double right) {
    const double bend = left - 2.0 * middle + right;
    return bend < 0.0 ? 0.5 * (left - right) / bend : 0.0;
  }

  cv::Mat values_;
  double height_ = 0.0;
  cv::Point peak_;
};

}  // namespace

double Shift::length() const {
  return std::hypot(x, y);
}

BorderPatches take_border(const cv::Mat& image) {
  BorderPatches border;
  const std::vector<cv::Rect> places = border_places(image.size());
  border.patches.resize(places.size());
  cv::parallel_for_({0, static_cast<int>(places.size())}, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const auto number = static_cast<std::size_t>(i);
      border.patches[number] = take_patch(image, places[number]);
    }
  });
  return border;
}

std::optional<Shift> measure_shift(const BorderPatches& now, const BorderPatches& before) {
  const std::size_t count = now.patches.size();
  if (count == 0 || count != before.patches.size() ||
      now.patches.front().size() != before.patches.front().size()) {
    return std::nullopt;
  }
  cv::Mat window;
  cv::createHanningWindow(window, now.patches.front().size(), CV_32F);
  std::vector<cv::Mat> products(count);
  cv::parallel_for_({0, static_cast<int>(count)}, [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const auto number = static_cast<std::size_t>(i);
      products[number] = phases(now.patches[number], before.patches[number], window);
    }
  });
  cv::Mat sum = products.front();
  for (std::size_t i = 1; i < count; ++i) sum += products[i];
  cv::Mat values;
  cv::idft(sum, values, cv::DFT_REAL_OUTPUT | cv::DFT_SCALE);
  const Correlation correlation(values);
  const double agreed = correlation.height() / static_cast<double>(count);
  if (agreed < kLeastPeak || correlation.height() < kAlone * correlation.next_height()) {
    return std::nullopt;
  }
  const cv::Point2d place = correlation.place();
  return Shift{kScale * place.x, kScale * place.y};
}

}  // namespace biotomy::acquisition
