#include "reconstruct/store/level_mean.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "reconstruct/whole_loop.hpp"

namespace biotomy::reconstruct {
namespace {

constexpr int kColours = 3;
constexpr std::size_t kRowsOfATask = 16;

int halved(int size, bool half) {
  return half ? (size + 1) / 2 : size;
}

/// The rows of up to 2 layers that one output row is the mean of.
template <typename Value>
struct Rows {
  std::array<const Value*, 4> rows{};
  std::size_t count = 0;  // 1, 2 or 4

  void add(const Value* row) { rows[count++] = row; }
};

/// `Sum` holds the sum of 8 values. `sums` is working memory of a row.
template <typename Value, typename Sum>
void mean_of_rows(const Rows<Value>& in, int columns, bool halve_x, Value* out,
                  std::vector<Sum>& sums) {
  const auto values = static_cast<std::size_t>(columns) * kColours;
  sums.assign(in.rows[0], in.rows[0] + values);
  for (std::size_t r = 1; r < in.count; ++r) {
    const Value* row = in.rows[r];
    for (std::size_t i = 0; i < values; ++i) {
      sums[i] = static_cast<Sum>(sums[i] + row[i]);
    }
  }
  const int shift = std::countr_zero(in.count);
  const auto rounded = [](unsigned sum, int bits) {
    return static_cast<Value>((sum + ((1U << bits) >> 1)) >> bits);
  };
  if (!halve_x) {
    for (std::size_t i = 0; i < values; ++i) {
      out[i] = rounded(sums[i], shift);
    }
    return;
  }
  const Sum* sum = sums.data();
  for (int pair = 0; pair < columns / 2; ++pair, sum += 2 * kColours, out += kColours) {
    for (int c = 0; c < kColours; ++c) {
      out[c] = rounded(static_cast<unsigned>(sum[c]) + sum[kColours + c], shift + 1);
    }
  }
  for (int c = 0; c < kColours && columns % 2 != 0; ++c) {
    out[c] = rounded(sum[c], shift);
  }
}

template <typename Value, typename Sum>
void fill_means(const std::vector<cv::Mat>& layers, const HalvedAxes& axes,
                std::vector<cv::Mat>& means) {
  const auto rows = static_cast<std::size_t>(means.front().rows);
  const auto mean_row = [&](std::size_t number, std::vector<Sum>& sums) {
    const std::size_t layer = number / rows;
    const int y = static_cast<int>(number % rows);
    const std::size_t first_layer = axes.z ? 2 * layer : layer;
    const std::size_t layer_count = axes.z && first_layer + 1 < layers.size() ? 2 : 1;
    const int first_row = axes.y ? 2 * y : y;
    const int row_count = axes.y && first_row + 1 < layers.front().rows ? 2 : 1;
    Rows<Value> in;
    for (std::size_t k = 0; k < layer_count; ++k) {
      for (int j = 0; j < row_count; ++j) {
        in.add(layers[first_layer + k].ptr<Value>(first_row + j));
      }
    }
    mean_of_rows(in, layers.front().cols, axes.x, means[layer].ptr<Value>(y), sums);
  };
  const std::size_t count = rows * means.size();
  whole_loop((count + kRowsOfATask - 1) / kRowsOfATask, [&](std::size_t task) {
    std::vector<Sum> sums;
    const std::size_t end = std::min((task + 1) * kRowsOfATask, count);
    for (std::size_t number = task * kRowsOfATask; number < end; ++number) {
      mean_row(number, sums);
    }
  });
}

}  // namespace

HalvedAxes halved_axes(const LevelFactor& before, const LevelFactor& level) {
  return {level.x > before.x, level.y > before.y, level.z > before.z};
}

std::vector<cv::Mat> level_mean(const std::vector<cv::Mat>& layers, const HalvedAxes& axes) {
  if (layers.empty()) {
    return {};
  }
  const cv::Mat& first = layers.front();
  std::vector<cv::Mat> means((layers.size() + (axes.z ? 1 : 0)) / (axes.z ? 2 : 1));
  for (cv::Mat& mean : means) {
    mean.create(halved(first.rows, axes.y), halved(first.cols, axes.x), first.type());
  }
  if (first.depth() == CV_8U) {
    fill_means<std::uint8_t, std::uint16_t>(layers, axes, means);
  } else {
    fill_means<std::uint16_t, std::uint32_t>(layers, axes, means);
  }
  return means;
}

}  // namespace biotomy::reconstruct
