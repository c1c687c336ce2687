#include "acquisition/quality/surface_colours.hpp"

#include <algorithm>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

namespace biotomy::acquisition {
namespace {

constexpr int kMostRegions = 24;  // along a side
constexpr int kLeastSide = 6;     // cells of a region

int parts(int length, int side) {
  return (length + side - 1) / side;
}

}  // namespace

cv::Mat surface_scale(const cv::Mat& thumbnail) {
  cv::Mat cells(thumbnail.size(), CV_8UC3);
  cv::parallel_for_({0, thumbnail.rows}, [&](const cv::Range& rows) {
    cv::Mat root;
    cv::sqrt(thumbnail.rowRange(rows), root);
    root.convertTo(cells.rowRange(rows), CV_8UC3, 255.0);
  });
  return cells;
}

std::size_t SurfaceColours::word_of(const cv::Vec3b& cell) {
  constexpr int kShift = 8 - kStepBits;
  return static_cast<std::size_t>(((cell[0] >> kShift) << kStepBits) | (cell[1] >> kShift));
}

std::uint32_t SurfaceColours::bit_of(const cv::Vec3b& cell) {
  return std::uint32_t{1} << static_cast<unsigned>(cell[2] >> (8 - kStepBits));
}

SurfaceColours::SurfaceColours(const cv::Mat& cells)
    : frame_(cells.size()),
      side_(std::max(kLeastSide, parts(std::max(cells.cols, cells.rows), kMostRegions))),
      columns_(parts(cells.cols, side_)),
      rows_(parts(cells.rows, side_)),
      sets_(kWords * static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
  cv::parallel_for_({0, rows_}, [&](const cv::Range& rows) {
    const int end = std::min(rows.end * side_, cells.rows);
    for (int y = rows.start * side_; y < end; ++y) {
      const auto* row = cells.ptr<cv::Vec3b>(y);
      for (int x = 0; x < cells.cols; ++x) {
        region(x / side_, y / side_)[word_of(row[x])] |= bit_of(row[x]);
      }
    }
  });
}

KnownColours::KnownColours(const std::vector<std::shared_ptr<const SurfaceColours>>& faces)
    : known_(*faces.front()) {
  constexpr std::size_t kWords = SurfaceColours::kWords;
  constexpr std::size_t kRed = SurfaceColours::kSteps;  // words from one step of R to the next
  SurfaceColours all = known_;
  const std::size_t row_of_sets = kWords * static_cast<std::size_t>(known_.columns_);
  cv::parallel_for_({0, known_.rows_}, [&](const cv::Range& rows) {
    const std::size_t begin = row_of_sets * static_cast<std::size_t>(rows.start);
    const std::size_t end = row_of_sets * static_cast<std::size_t>(rows.end);
    for (const auto& face : faces) {
      for (std::size_t k = begin; k < end; ++k) all.sets_[k] |= face->sets_[k];
    }
  });
  cv::parallel_for_({0, known_.rows_}, [&](const cv::Range& rows) {
    std::vector<std::uint32_t> nearby(kWords);
    std::vector<std::uint32_t> wider(kWords);
    for (int y = rows.start; y < rows.end; ++y) {
      for (int x = 0; x < known_.columns_; ++x) {
        std::ranges::fill(nearby, 0U);
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, known_.rows_ - 1); ++j) {
          for (int i = std::max(x - 1, 0); i <= std::min(x + 1, known_.columns_ - 1); ++i) {
            const std::uint32_t* set = all.region(i, j);
            for (std::size_t k = 0; k < kWords; ++k) nearby[k] |= set[k];
          }
        }
        // A step of B is a bit, of G a word, of R a row of words.
        for (std::size_t k = 0; k < kWords; ++k) {
          nearby[k] |= (nearby[k] << 1U) | (nearby[k] >> 1U);
        }
        for (std::size_t k = 0; k < kWords; ++k) {
          const std::size_t green = k % kRed;
          wider[k] = nearby[k] | (green > 0 ? nearby[k - 1] : 0U) |
                     (green + 1 < kRed ? nearby[k + 1] : 0U);
        }
        std::uint32_t* known = known_.region(x, y);
        for (std::size_t k = 0; k < kWords; ++k) {
          known[k] = wider[k] | (k >= kRed ? wider[k - kRed] : 0U) |
                     (k + kRed < kWords ? wider[k + kRed] : 0U);
        }
      }
    }
  });
}

cv::Mat KnownColours::unknown_in(const cv::Mat& cells) const {
  cv::Mat unknown(cells.size(), CV_8UC1);
  cv::parallel_for_({0, cells.rows}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      const auto* row = cells.ptr<cv::Vec3b>(y);
      auto* out = unknown.ptr<std::uint8_t>(y);
      for (int x = 0; x < cells.cols; ++x) {
        const std::uint32_t* set = known_.region(x / known_.side_, y / known_.side_);
        const bool known =
            (set[SurfaceColours::word_of(row[x])] & SurfaceColours::bit_of(row[x])) != 0;
        out[x] = known ? 0 : 255;
      }
    }
  });
  return unknown;
}

}  // namespace biotomy::acquisition
