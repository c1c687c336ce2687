#include "sim/physics/camera.hpp"

#include <cmath>
#include <numbers>

namespace biotomy::sim {

namespace {

const cv::Scalar kEmptyBed(21, 22, 24);  // dark anodised aluminium

/// How far a sinusoidal vibration of this RMS velocity swings from end to end. Frames stand on feet
/// of rubber, with a resonance of some 15 Hz.
double swing_um(double vibration_mm_s) {
  constexpr double kResonanceHz = 15;
  return 1e3 * 2.0 * std::numbers::sqrt2 * vibration_mm_s / (2.0 * std::numbers::pi * kResonanceHz);
}

}  // namespace

Camera::Camera(std::uint64_t seed, const Phantom& phantom, double first_face_um,
               const CameraOptics& optics, const SensorSettings& sensor)
    : seed_(seed),
      optics_(optics),
      painter_(phantom, optics.view, first_face_um),
      sensor_(seed, optics.view.width, optics.view.height, sensor) {}

bool Camera::place_face(double traverse_um, const cv::Mat& face, cv::Mat& light) const {
  const double away = traverse_um / optics_.view.pixel_um;
  if (std::fabs(away) >= optics_.view.width) {
    light.create(optics_.view.height, optics_.view.width, CV_32FC3);
    light.setTo(kEmptyBed);
    return false;
  }
  const int shift = static_cast<int>(std::lround(away));
  if (shift == 0) {
    face.copyTo(light);
    return true;
  }
  light.create(face.size(), CV_32FC3);
  light.setTo(kEmptyBed);
  const int width = face.cols - std::abs(shift);
  const cv::Rect from(shift < 0 ? -shift : 0, 0, width, face.rows);
  const cv::Rect to(shift > 0 ? shift : 0, 0, width, face.rows);
  face(from).copyTo(light(to));
  return true;
}

Photograph Camera::take(const Scene& begin, const Scene& end, const ExposureSettings& exposure) {
  Photograph photograph;
  photograph.number = ++photographs_;
  const double column_um = 0.5 * (begin.column_um + end.column_um);
  photograph.defocus_um = end.block.mean_um() - (column_um + optics_.column_offset_um);

  // Far from the camera the face need not be drawn.
  const double traverse_um = 0.5 * (begin.traverse_um + end.traverse_um);
  const bool near = std::fabs(traverse_um) < optics_.view.width * optics_.view.pixel_um;
  cv::Mat light;
  photograph.face_in_view = place_face(
      traverse_um, near ? painter_.paint(end.block, end.displacement) : cv::Mat(), light);
  if (photograph.face_in_view) {
    lay_film(light, end.film, seed_ + end.block.state().passes);
    const double moved_um = std::fabs(end.traverse_um - begin.traverse_um) +
                            swing_um(0.5 * (begin.vibration_mm_s + end.vibration_mm_s));
    smear_along_rows(light, moved_um / optics_.view.pixel_um);
    blur_tilted(light, optics_.lens, optics_.view.pixel_um, photograph.defocus_um, optics_.tilt);
  }
  if (!end.lamp_field.is_even()) light_up(light, end.lamp_field);
  const double lamp =
      begin.lamp_on && end.lamp_on ? 0.5 * (begin.lamp_share + end.lamp_share) : 0.0;
  photograph.image = sensor_.expose(light, lamp, exposure, photograph.number);
  return photograph;
}

}  // namespace biotomy::sim
