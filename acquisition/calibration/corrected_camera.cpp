#include "acquisition/calibration/corrected_camera.hpp"

#include <optional>
#include <sstream>
#include <utility>

#include "acquisition/calibration/calibration_record.hpp"

namespace biotomy::acquisition {
namespace {

std::string settings_text(const bridge::CameraSettings& settings) {
  std::ostringstream text;
  text << settings.exposure.count() << " µs, gain " << settings.gain << ", red_gain "
       << settings.red_gain << ", blue_gain " << settings.blue_gain;
  return text.str();
}

/// What a field depends on: the lens moves with the face.
bridge::CameraSettings without_lens(bridge::CameraSettings settings) {
  settings.lens_position.reset();
  return settings;
}

/// A calibration for frames of this camera with these settings, which say nothing of the lens.
CalibrationFrame read_fitting(const CalibrationPlan& plan, FieldKind kind,
                              const bridge::CameraDescription& camera,
                              const bridge::CameraSettings& settings) {
  CalibrationFrame frame = read_calibration_frame(plan.folder, kind, camera.transfer);
  const std::string name = std::string("the ") + to_string(kind) + " field";
  const std::string again =
      std::string("record it again with biotomy calibrate ") + to_string(kind);
  if (frame.mean.cols != camera.width || frame.mean.rows != camera.height) {
    throw CalibrationError(name + " has " + std::to_string(frame.mean.cols) + " × " +
                           std::to_string(frame.mean.rows) + " pixels and the camera " +
                           std::to_string(camera.width) + " × " + std::to_string(camera.height) +
                           ": " + again);
  }
  if (frame.settings != settings) {
    throw CalibrationError(name + " was recorded with " + settings_text(frame.settings) +
                           " and the camera is set to " + settings_text(settings) + ": " + again +
                           ", or restore the settings");
  }
  return frame;
}

std::string note_of(FieldKind kind, const CalibrationFrame& frame) {
  return std::string(to_string(kind)) + " field " + short_hash(frame.sha256) + " of " +
         frame.taken_at;
}

}  // namespace

CorrectedCamera::CorrectedCamera(bridge::Camera& camera, CalibrationPlan plan)
    : camera_(camera), plan_(std::move(plan)) {}

bridge::CameraDescription CorrectedCamera::describe() {
  bridge::CameraDescription description = camera_.describe();
  description.correction = in_force_;
  return description;
}

void CorrectedCamera::apply(const bridge::CameraSettings& settings) {
  camera_.apply(settings);
  const bridge::CameraSettings asked = without_lens(settings);
  if (settings.lens_position && asked == applied_) return;
  applied_.reset();
  correction_.reset();
  in_force_.clear();
  const bridge::CameraDescription description = camera_.describe();
  std::optional<CalibrationFrame> flat;
  std::optional<CalibrationFrame> dark;
  if (plan_.flat) flat = read_fitting(plan_, FieldKind::flat, description, asked);
  if (plan_.dark) dark = read_fitting(plan_, FieldKind::dark, description, asked);
  if (!flat && !dark) {
    applied_ = asked;
    return;
  }
  bits_ = flat ? flat->bits : dark->bits;
  if (flat && dark && flat->bits != dark->bits) {
    throw CalibrationError("the flat field is of " + std::to_string(flat->bits) +
                           " bits and the dark field of " + std::to_string(dark->bits) +
                           ": record both again");
  }
  correction_ = std::make_unique<FieldCorrection>(
      flat ? flat->mean : cv::Mat(), dark ? dark->mean : cv::Mat(),
      bits_ == 16 ? CV_16UC3 : CV_8UC3, description.transfer);
  if (flat) in_force_ = note_of(FieldKind::flat, *flat);
  if (dark) in_force_ += (in_force_.empty() ? "" : ", ") + note_of(FieldKind::dark, *dark);
  // A sample of which earlier versions corrected the coded values must not be gone on with unseen.
  if (description.transfer == bridge::Transfer::srgb) in_force_ += ", on the light behind sRGB";
  applied_ = asked;
}

bridge::Frame CorrectedCamera::capture(std::chrono::milliseconds time_out) {
  bridge::Frame frame = camera_.capture(time_out);
  // A frame of another size is left as it is: the assessment knows what to say of it.
  if (!correction_ || !correction_->fits(frame.image.size())) return frame;
  if ((frame.image.depth() == CV_16U ? 16 : 8) != bits_) {
    throw CalibrationError("the camera gives frames of other bits than the " +
                           std::to_string(bits_) + " of its calibrations: record them again");
  }
  correction_->apply(frame.image);
  return frame;
}

}  // namespace biotomy::acquisition
