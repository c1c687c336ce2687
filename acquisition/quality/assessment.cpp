#include "acquisition/quality/assessment.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

#include "acquisition/quality/face_judgement.hpp"
#include "acquisition/quality/judgement.hpp"
#include "acquisition/quality/sharpness.hpp"

namespace biotomy::acquisition {
namespace {

template <typename Sample>
std::int64_t count_clipped(const Sample* pixels, int count) {
  constexpr Sample kFull = std::numeric_limits<Sample>::max();
  std::int64_t clipped = 0;
  for (int i = 0; i < count; ++i, pixels += 3) {
    clipped += static_cast<int>(pixels[0] == kFull || pixels[1] == kFull || pixels[2] == kFull);
  }
  return clipped;
}

/// The part of pixels in which at least one colour is at full scale.
double clipped_fraction(const cv::Mat& image) {
  std::atomic<std::int64_t> clipped{0};
  cv::parallel_for_({0, image.rows}, [&](const cv::Range& rows) {
    std::int64_t found = 0;
    for (int y = rows.start; y < rows.end; ++y) {
      found += image.depth() == CV_16U ? count_clipped(image.ptr<std::uint16_t>(y), image.cols)
                                       : count_clipped(image.ptr<std::uint8_t>(y), image.cols);
    }
    clipped += found;
  });
  return static_cast<double>(clipped) / static_cast<double>(image.total());
}

std::string description(int width, int height, int type) {
  return std::to_string(width) + " × " + std::to_string(height) +
         (type == CV_16UC3  ? " of 16 bits"
          : type == CV_8UC3 ? " of 8 bits"
                            : " of another kind");
}

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::accepted:
      return "accepted";
    case Verdict::accepted_with_flag:
      return "accepted_with_flag";
    case Verdict::rejected:
      return "rejected";
    case Verdict::not_stored:
      return "not_stored";
  }
  return "?";
}

Assessment assess(const bridge::Frame& frame, const FrameExpectation& expectation,
                  const QualityThresholds& thresholds) {
  Judgement judgement;
  const cv::Mat& image = frame.image;
  if (image.cols != expectation.width || image.rows != expectation.height ||
      image.type() != expectation.type) {
    judgement.reject("wrong-size",
                     "the frame is " + description(image.cols, image.rows, image.type()) +
                         " and the sample " +
                         description(expectation.width, expectation.height, expectation.type));
    judgement.result().shows_the_face = false;
    return judgement.finish();
  }
  judge_moment(frame, expectation, judgement);

  const cv::Mat brightness = brightness_of(image);
  const double mean = cv::mean(brightness)[0];
  judgement.at_least(
      "brightness_minimum", mean, thresholds.minimum_brightness, "too-dark",
      "the mean brightness is %.3f of full scale, below %.3f: the lamp is dark, the exposure "
      "too short or the camera blind");
  judgement.at_most("brightness_maximum", mean, thresholds.maximum_brightness, "too-bright",
                    "the mean brightness is %.3f of full scale, above %.3f");
  judgement.at_most("clipped_fraction", clipped_fraction(image),
                    thresholds.maximum_clipped_fraction, "clipped",
                    "%.4f of the pixels are at full scale, more than %.4f");

  Assessment& result = judgement.result();
  result.sharpness = sharpness_of_brightness(brightness);
  result.sharpness_ratio =
      expectation.focus_sharpness > 0.0 ? result.sharpness / expectation.focus_sharpness : 0.0;
  judgement.at_least("sharpness_ratio", result.sharpness_ratio, thresholds.minimum_sharpness_ratio,
                     "blurred", "the sharpness is %.3f of the focus peak's, below %.3f");

  result.face = std::make_shared<const FacePrint>(take_face_print(image));
  judge_rows(expectation.faces, thresholds, judgement);
  judge_face_change(expectation.faces, thresholds, judgement);
  return judgement.finish();
}

}  // namespace biotomy::acquisition
