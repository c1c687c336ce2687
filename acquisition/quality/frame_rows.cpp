#include "acquisition/quality/frame_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include <opencv2/core.hpp>

namespace biotomy::acquisition {
namespace {

constexpr std::size_t kStretch = 64;     // a cache line; what is read of a row is read whole
constexpr std::size_t kShortRow = 4096;  // bytes; looked at without gaps
constexpr std::size_t kStride = 8;       // of long rows one stretch in so many
constexpr std::size_t kNoisyShare = 4;   // one neighbour in so many differs
constexpr std::uint64_t kFirst = 0x9e3779b97f4a7c15;
constexpr std::uint64_t kFactor = 0xff51afd7ed558ccd;

/// Not to be fooled on purpose, only by chance: every byte reaches the upper bits, and these are
/// folded back.
std::uint64_t mixed(std::uint64_t hash, const std::uint8_t* bytes, std::size_t count) {
  for (std::size_t i = 0; i < count; i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, std::min(sizeof word, count - i));
    hash = (hash ^ word) * kFactor;
    hash ^= hash >> 32U;
  }
  return hash;
}

FrameRows::Row row_of(const std::uint8_t* bytes, std::size_t length, std::size_t pixel) {
  FrameRows::Row row{.hash = kFirst};
  const std::size_t step = length <= kShortRow ? kStretch : kStretch * kStride;
  std::size_t differing = 0;
  std::size_t compared = 0;
  for (std::size_t begin = 0; begin < length; begin += step) {
    const std::size_t count = std::min(kStretch, length - begin);
    const std::uint8_t* stretch = bytes + begin;
    row.hash = mixed(row.hash, stretch, count);
    const std::size_t pairs = std::min(count, length - begin - std::min(length - begin, pixel));
    for (std::size_t i = 0; i < pairs; ++i) {
      differing += stretch[i] != stretch[i + pixel] ? 1U : 0U;
    }
    compared += pairs;
  }
  row.kind = differing == 0                       ? FrameRows::Kind::constant
             : differing * kNoisyShare < compared ? FrameRows::Kind::plain
                                                  : FrameRows::Kind::noisy;
  return row;
}

}  // namespace

FrameRows rows_of(const cv::Mat& image) {
  FrameRows result;
  result.rows.resize(static_cast<std::size_t>(image.rows));
  const std::size_t pixel = image.elemSize();
  const std::size_t length = pixel * static_cast<std::size_t>(image.cols);
  cv::parallel_for_({0, image.rows}, [&](const cv::Range& range) {
    for (int y = range.start; y < range.end; ++y) {
      result.rows[static_cast<std::size_t>(y)] = row_of(image.ptr(y), length, pixel);
    }
  });
  return result;
}

RepeatedRows repeated_rows(const FrameRows& now, const FrameRows& earlier) {
  RepeatedRows count;
  for (std::size_t i = 0; i < now.rows.size(); ++i) {
    if (now.rows[i].kind != FrameRows::Kind::noisy) continue;
    ++count.noisy;
    if (i < earlier.rows.size() && now.rows[i].hash == earlier.rows[i].hash) ++count.repeated;
  }
  return count;
}

double dead_share(const FrameRows& now, const FrameRows* reference) {
  std::size_t constant = 0;
  std::size_t dead = 0;
  for (std::size_t i = 0; i < now.rows.size(); ++i) {
    if (now.rows[i].kind != FrameRows::Kind::constant) continue;
    ++constant;
    const bool was_constant = reference != nullptr && i < reference->rows.size() &&
                              reference->rows[i].kind == FrameRows::Kind::constant;
    if (!was_constant) ++dead;
  }
  if (constant == now.rows.size()) return 0.0;
  return static_cast<double>(dead) / static_cast<double>(now.rows.size());
}

}  // namespace biotomy::acquisition
