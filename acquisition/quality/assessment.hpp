#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acquisition/quality/camera_noise.hpp"
#include "acquisition/quality/face_change.hpp"
#include "acquisition/quality/face_print.hpp"
#include "acquisition/quality/face_record.hpp"
#include "acquisition/quality/frame_measures.hpp"
#include "acquisition/quality/sharpness_record.hpp"
#include "acquisition/quality/surface_record.hpp"
#include "firmware_bridge/camera/frame.hpp"

namespace biotomy::acquisition {

enum class Verdict {
  accepted,
  accepted_with_flag,  ///< not good enough, kept because the configuration says so
  rejected,
  not_stored,  ///< good, but it could not be written
};

const char* to_string(Verdict verdict);

/// A named property of a frame and whether it is as it should be.
struct Metric {
  std::string name;
  double value = 0.0;
  double limit = 0.0;  ///< the threshold that it was compared with
  bool passed = true;
};

/// What was found out about one frame.
struct Assessment {
  Verdict verdict = Verdict::rejected;
  std::string slug;    ///< the reason as part of a file name: "blurred"; "good" when accepted
  std::string reason;  ///< the reason as a sentence
  std::vector<Metric> metrics;
  double sharpness = 0.0;  ///< see sharpness_comparison.hpp; 0 without detail
  /// To the last focus search's sharpest frame, whatever decided; nothing without one.
  std::optional<double> sharpness_to_peak;

  /// False when it is a picture of something else than the face in work: of the face before, of an
  /// earlier moment, of a part only, or not of the sample's size. Such a frame is never the layer,
  /// whatever the policy: it would be stored under a name that lies.
  bool shows_the_face = true;
  /// False when a fresh picture shows still the last accepted layer's face.
  bool face_changed = true;
  /// True when it was rejected for its sharpness and for nothing else, and is still sharp enough to
  /// show that its face is a new one. Only such a frame may be kept with a flag.
  bool lacks_only_sharpness = false;
  FaceChange face_change;  ///< from the last accepted layer's face
  // None of these when the frame is not of the sample's size.
  std::shared_ptr<const FacePrint> face;
  std::shared_ptr<const FrameMeasures> measures;
  /// As this frame and the focus search's of the same face tell it; nothing without such a search.
  std::optional<CameraNoise> noise;
  std::shared_ptr<const SurfacePrint> surface;
  FrameLight light;
  double arrived = 0.0;  ///< part of the frame in which new tissue came up: see SurfaceDefects
};

/// Thresholds of the metrics, each under the metric's name.
struct QualityThresholds {
  double minimum_sharpness_ratio = 0.96;
  double minimum_sharpness_to_record = 0.75;  ///< after a search of the same layer
  double minimum_sharpness_along_axis = 0.97;
  double minimum_fine_contrast = 0.7;       ///< of what the sharpness is compared with
  double maximum_blurred_part = 0.15;       ///< of the frame, in one piece
  double minimum_brightness = 0.05;         ///< mean, of full scale
  double maximum_brightness = 0.95;         ///< mean, of full scale
  double maximum_clipped_fraction = 0.05;   ///< of pixels with a clipped colour
  double maximum_brightness_change = 0.05;  ///< of the light, against the last layers'
  double maximum_unevenness = 0.08;         ///< likewise: how much it differs over the frame
  double maximum_colour_cast = 0.035;       ///< likewise: how much it differs between the colours
  double maximum_brightness_drift = 0.25;   ///< of the casting material, against the first layer's
  double maximum_colour_drift = 0.1;        ///< likewise: how much it differs between the colours
  double maximum_shift = 3.0;               ///< pixels, against the last layer
  double maximum_debris = 0.0025;           ///< part of the frame
  double maximum_frost = 0.02;              ///< part of the frame
  double maximum_glare = 0.0005;            ///< part of the frame
  double maximum_shade = 0.02;              ///< part of the frame
  double maximum_dead_rows = 0.01;          ///< part of the rows; see dead_share
  double maximum_repeated_rows = 0.0;       ///< part of the noisy rows; see repeated_rows
  double minimum_face_change = 0.0015;      ///< of the fine detail's energy; 0: not judged
  /// And of the least that the last faces changed.
  double minimum_face_change_ratio = 0.33;
  double maximum_old_part = 0.0;  ///< of the frame, from an edge on, may still be the face before
};

/// What a frame is compared with.
struct FrameExpectation {
  int width = 0;
  int height = 0;
  int type = 0;                                    ///< CV_8UC3 or CV_16UC3
  std::int64_t layer = 0;                          ///< in work
  std::optional<std::uint64_t> previous_sequence;  ///< of the frame before
  std::chrono::nanoseconds previous_timestamp{0};  ///< of the frame before; 0 is unknown
  std::chrono::nanoseconds asked_at{0};            ///< the camera, by its clock; 0 is unknown
  FaceRecord faces{};                              ///< the faces and frames before
  SharpnessRecord sharpness{};
  SurfaceRecord surfaces{};
};

/// Judges one frame. A frame that is of another size or kind than the sample's is rejected before
/// anything is measured.
Assessment assess(const bridge::Frame& frame, const FrameExpectation& expectation,
                  const QualityThresholds& thresholds);

}  // namespace biotomy::acquisition
