#include "acquisition/quality/assessment.hpp"

#include <cstddef>
#include <string>

#include <opencv2/core.hpp>

#include "acquisition/quality/face_judgement.hpp"
#include "acquisition/quality/judgement.hpp"
#include "acquisition/quality/light_judgement.hpp"
#include "acquisition/quality/noise_judgement.hpp"
#include "acquisition/quality/sharpness_judgement.hpp"
#include "acquisition/quality/surface_judgement.hpp"

namespace biotomy::acquisition {
namespace {

struct Light {
  double brightness = 0.0;  ///< mean, of full scale; what is clipped counts as full
  double clipped = 0.0;     ///< part of the pixels
};

Light light_of(const FrameMeasures& measures) {
  Light light;
  double area = 0.0;
  for (int i = 0; i < measures.grid.count(); ++i) {
    const TileMeasures& tile = measures.tiles[static_cast<std::size_t>(i)];
    const double pixels = measures.grid.tile(i).area();
    area += pixels;
    light.clipped += pixels * tile.clipped;
    light.brightness += pixels * ((1.0 - tile.clipped) * tile.brightness() + tile.clipped);
  }
  light.clipped /= area;
  light.brightness /= area;
  return light;
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

  Assessment& result = judgement.result();
  result.face = std::make_shared<const FacePrint>(take_face_print(image));
  judge_rows(expectation.faces, thresholds, judgement);

  SharpnessRecord sharpness = expectation.sharpness;
  result.measures = std::make_shared<const FrameMeasures>(measure_frame(image));
  judge_noise(expectation.layer, sharpness, judgement);
  const Light light = light_of(*result.measures);
  judgement.at_least(
      "brightness_minimum", light.brightness, thresholds.minimum_brightness, "too-dark",
      "the mean brightness is %.3f of full scale, below %.3f: the lamp is dark, the exposure "
      "too short or the camera blind");
  judgement.at_most("brightness_maximum", light.brightness, thresholds.maximum_brightness,
                    "too-bright", "the mean brightness is %.3f of full scale, above %.3f");
  judgement.at_most("clipped_fraction", light.clipped, thresholds.maximum_clipped_fraction,
                    "clipped", "%.4f of the pixels are clipped, more than %.4f");

  result.surface = std::make_shared<const SurfacePrint>(take_surface_print(image));
  result.light = find_light(*result.surface, expectation.surfaces);
  // What lies on a face changes its light too.
  judge_surface(image, result.measures->clipping, expectation.surfaces, thresholds, judgement);
  judge_light(expectation.surfaces, thresholds, judgement);

  const bool good_so_far = result.slug.empty();
  const bool has_detail = judge_sharpness(sharpness, expectation.layer, thresholds, judgement);
  const bool lacks_sharpness = good_so_far && !result.slug.empty();
  const bool face_is_told =
      judge_face_change(expectation.faces, sharpness.noise_of_faces(), thresholds, judgement);
  // A face whose detail is gone counts as changed, whatever it is the face of.
  result.lacks_only_sharpness =
      lacks_sharpness && has_detail && face_is_told && result.shows_the_face;
  return judgement.finish();
}

}  // namespace biotomy::acquisition
