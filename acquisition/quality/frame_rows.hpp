#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace biotomy::acquisition {

/// What is kept of a frame's rows to recognise them in a later frame.
///
/// A sensor's noise never repeats: two exposures of one scene have no row in common. A row that is,
/// byte for byte, the same as one of an earlier frame was therefore not exposed again but comes
/// from memory: the whole frame is old, or the camera stopped writing it half-way.
struct FrameRows {
  enum class Kind : std::uint8_t {
    constant,  ///< every pixel the same: nothing was read out, or all of it is clipped
    plain,     ///< hardly any noise; to be equal says nothing
    noisy,     ///< at least a quarter of neighbouring values differ
  };
  struct Row {
    std::uint64_t hash = 0;
    Kind kind = Kind::constant;
  };
  std::vector<Row> rows;
};

/// Of an image of any size and kind. Of long rows an eighth is looked at, spread over the row.
FrameRows rows_of(const cv::Mat& image);

/// How many of the noisy rows of `now` are, byte for byte, the same rows of `earlier`, and how
/// many there are.
struct RepeatedRows {
  int repeated = 0;
  int noisy = 0;
};
RepeatedRows repeated_rows(const FrameRows& now, const FrameRows& earlier);

/// The part of the rows of `now` that are constant where `reference`'s are not; without a reference
/// (null) where any are constant. 0 when all are: that is a matter of brightness.
double dead_share(const FrameRows& now, const FrameRows* reference);

}  // namespace biotomy::acquisition
