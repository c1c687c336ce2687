#include "acquisition/quality/thumbnail.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

namespace biotomy::acquisition {
namespace {

constexpr int kColours = 3;

/// `Sum` holds eight samples, and the whole of a cell is summed in 32 bits.
template <typename Sample, typename Sum>
void shrink_row(const cv::Mat& image, int row, std::vector<Sum>& columns, float* cells, int count) {
  const auto width = columns.size();
  std::fill(columns.begin(), columns.end(), Sum{0});
  for (int y = 0; y < kCell; ++y) {
    const Sample* pixels = image.ptr<Sample>(row * kCell + y);
    Sum* sums = columns.data();
    for (std::size_t i = 0; i < width; ++i) sums[i] = static_cast<Sum>(sums[i] + pixels[i]);
  }
  constexpr float kScale = 1.0F / (static_cast<float>(kCell * kCell) *
                                   static_cast<float>(std::numeric_limits<Sample>::max()));
  const Sum* sums = columns.data();
  for (int cell = 0; cell < count; ++cell, sums += kColours * kCell, cells += kColours) {
    for (int c = 0; c < kColours; ++c) {
      std::uint32_t sum = 0;
      for (int x = 0; x < kCell; ++x) sum += sums[kColours * x + c];
      cells[c] = kScale * static_cast<float>(sum);
    }
  }
}

template <typename Sample, typename Sum>
void shrink(const cv::Mat& image, cv::Mat& cells) {
  cv::parallel_for_({0, cells.rows}, [&](const cv::Range& rows) {
    std::vector<Sum> columns(static_cast<std::size_t>(kColours * kCell * cells.cols));
    for (int row = rows.start; row < rows.end; ++row) {
      shrink_row<Sample, Sum>(image, row, columns, cells.ptr<float>(row), cells.cols);
    }
  });
}

}  // namespace

cv::Mat take_thumbnail(const cv::Mat& image) {
  if (image.cols < kCell || image.rows < kCell) return {};
  cv::Mat cells(image.rows / kCell, image.cols / kCell, CV_32FC3);
  if (image.depth() == CV_16U) {
    shrink<std::uint16_t, std::uint32_t>(image, cells);
  } else {
    shrink<std::uint8_t, std::uint16_t>(image, cells);
  }
  return cells;
}

}  // namespace biotomy::acquisition
