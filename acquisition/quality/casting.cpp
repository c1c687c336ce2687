#include "acquisition/quality/casting.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

#include "acquisition/quality/median.hpp"

namespace biotomy::acquisition {
namespace {

constexpr int kBorderShare = 16;      ///< the border is a 16th of the shorter side wide, or a cell
constexpr double kAgreed = 0.6;       ///< of the border's cells have one colour
constexpr double kLeastShare = 0.02;  ///< of the frame; less casting material says nothing of it
constexpr std::size_t kLeastCells = 16;
constexpr float kDark = 0.004F;  ///< of full scale; darker cells have no chroma to speak of
constexpr double kLeastTolerance = 0.012;
constexpr double kMostTolerance = 0.04;
constexpr double kSpreads = 4.0;
constexpr double kNormal = 1.4826;  ///< a normal distribution's deviation by its median deviation

using Cells = std::vector<cv::Vec3f>;

float sum(const cv::Vec3f& cell) {
  return cell[0] + cell[1] + cell[2];
}

/// The shares of red and green. Of dark cells they are far from those of any material.
cv::Vec2f chroma(const cv::Vec3f& cell) {
  const float all = sum(cell);
  return all < 3.0F * kDark ? cv::Vec2f(-1.0F, -1.0F) : cv::Vec2f(cell[0] / all, cell[1] / all);
}

float distance(const cv::Vec2f& a, const cv::Vec2f& b) {
  return std::max(std::fabs(a[0] - b[0]), std::fabs(a[1] - b[1]));
}

template <typename Of>
auto median_over(const Cells& cells, const Of& of) {
  std::vector<decltype(of(cells.front()))> values;
  values.reserve(cells.size());
  for (const cv::Vec3f& cell : cells) values.push_back(of(cell));
  return median(std::move(values));
}

cv::Vec3d median_colour(const Cells& cells) {
  cv::Vec3d colour;
  for (int c = 0; c < 3; ++c) {
    colour[c] =
        static_cast<double>(median_over(cells, [c](const cv::Vec3f& cell) { return cell[c]; }));
  }
  return colour;
}

Cells border_of(const cv::Mat& thumbnail) {
  const int width = std::max(1, std::min(thumbnail.cols, thumbnail.rows) / kBorderShare);
  Cells cells;
  for (int y = 0; y < thumbnail.rows; ++y) {
    const auto* row = thumbnail.ptr<cv::Vec3f>(y);
    const bool whole = y < width || y >= thumbnail.rows - width;
    for (int x = 0; x < thumbnail.cols; ++x) {
      if (whole || x < width || x >= thumbnail.cols - width) cells.push_back(row[x]);
    }
  }
  return cells;
}

}  // namespace

std::optional<CastingColour> learn_casting(const cv::Mat& thumbnail) {
  if (thumbnail.empty()) return std::nullopt;
  const Cells border = border_of(thumbnail);
  const auto chroma_at = [](int i) {
    return [i](const cv::Vec3f& cell) { return chroma(cell)[i]; };
  };
  cv::Vec2f middle(median_over(border, chroma_at(0)), median_over(border, chroma_at(1)));
  if (middle[0] < 0.0F) return std::nullopt;
  const auto away = [&](const cv::Vec3f& cell) { return distance(chroma(cell), middle); };
  const double spread = kNormal * static_cast<double>(median_over(border, away));
  const double tolerance = std::clamp(kSpreads * spread, kLeastTolerance, kMostTolerance);
  Cells alike;
  std::ranges::copy_if(border, std::back_inserter(alike), [&](const cv::Vec3f& cell) {
    return static_cast<double>(away(cell)) <= tolerance;
  });
  if (static_cast<double>(alike.size()) < kAgreed * static_cast<double>(border.size())) {
    return std::nullopt;
  }
  CastingColour casting{median_colour(alike), 0.0, tolerance};
  return casting_within(thumbnail, casting_cells(thumbnail, casting), casting);
}

cv::Mat casting_cells(const cv::Mat& thumbnail, const CastingColour& casting) {
  const cv::Vec3f level(casting.level);
  const cv::Vec2f middle = chroma(level);
  const auto tolerance = static_cast<float>(casting.tolerance);
  cv::Mat mask(thumbnail.size(), CV_8UC1);
  cv::parallel_for_({0, thumbnail.rows}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      const auto* row = thumbnail.ptr<cv::Vec3f>(y);
      auto* out = mask.ptr<std::uint8_t>(y);
      for (int x = 0; x < thumbnail.cols; ++x) {
        const float all = sum(row[x]);
        const bool alike = distance(chroma(row[x]), middle) <= tolerance &&
                           all >= 0.5F * sum(level) && all <= 2.0F * sum(level);
        out[x] = alike ? 255 : 0;
      }
    }
  });
  return mask;
}

std::optional<CastingColour> casting_within(const cv::Mat& thumbnail, const cv::Mat& mask,
                                            const CastingColour& before) {
  Cells cells;
  for (int y = 0; y < thumbnail.rows; ++y) {
    const auto* row = thumbnail.ptr<cv::Vec3f>(y);
    for (int x = 0; x < thumbnail.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) != 0) cells.push_back(row[x]);
    }
  }
  const double share = static_cast<double>(cells.size()) / static_cast<double>(thumbnail.total());
  if (cells.size() < kLeastCells || share < kLeastShare) return std::nullopt;
  return CastingColour{median_colour(cells), share, before.tolerance};
}

}  // namespace biotomy::acquisition
