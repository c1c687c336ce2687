#include "tests/focus/twin_optics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/rig/lens_actuator.hpp"
#include "sim/phantom/gradient_noise.hpp"

namespace biotomy::tests {

namespace {

constexpr int kWidth = 480;
constexpr int kHeight = 360;
constexpr double kPixelUm = 10.0;
constexpr double kFirstFaceUm = 150350.0;
constexpr double kOffsetUm = 350.0;  ///< the focal plane's feed coordinate less the mover's
constexpr std::uint64_t kDriftStream = 0x6472696674;

sim::CameraOptics optics_of(const FocusCourse& course) {
  sim::CameraOptics optics;
  optics.view = {kWidth, kHeight, kPixelUm};
  optics.column_offset_um = kOffsetUm;
  optics.tilt = {course.tilt_across_um, course.tilt_down_um};
  return optics;
}

sim::PhantomSettings phantom_of(const FocusCourse& course) {
  return {.seed = course.seed,
          .width_um = course.specimen_um,
          .height_um = course.specimen_um * kHeight / kWidth,
          .depth_um = course.content_um};
}

sim::AxisSettings mover_of(const FocusCourse& course) {
  return {.speed_um_s = 1e5, .backlash_um = course.backlash_um};
}

/// Near enough to a standard normal.
double normal(std::uint64_t seed, std::uint64_t index) {
  double sum = -6.0;
  for (std::uint64_t i = 0; i < 12; ++i) sum += sim::mixed_fraction(seed, 12 * index + i);
  return sum;
}

}  // namespace

TwinOptics::TwinOptics(const FocusCourse& course)
    : mover(mover_of(course), kFirstFaceUm - kOffsetUm - 1000.0),
      course_(course),
      phantom_(phantom_of(course)),
      camera_(course.seed, phantom_, kFirstFaceUm, optics_of(course), {.mosaic = course.mosaic}),
      block_(course.seed, kFirstFaceUm, 0.3, sim::DebrisSettings{}),
      face_um_(kFirstFaceUm) {}

void TwinOptics::begin_layer(int layer) {
  face_um_ = kFirstFaceUm + (layer - 1) * course_.layer_thickness_um;
  block_.begin_pass(face_um_);
  block_.cut_to(1.0);
  block_.blow(400.0);
  wandered_um_ +=
      course_.wander_um * normal(course_.seed ^ kDriftStream, static_cast<std::uint64_t>(layer));
  const double knocked_um = 2 * layer > course_.layers ? course_.knock_um : 0.0;
  drift_um_ = knocked_um + course_.drift_um * layer + wandered_um_ +
              course_.swing_um * std::sin(2.0 * std::numbers::pi * layer / course_.swing_layers);
}

double TwinOptics::sharp_at_um() const {
  return block_.mean_um() - kOffsetUm + drift_um_;
}

sim::Photograph TwinOptics::photograph() {
  ++photographs;
  const sim::Scene scene{.block = block_,
                         .traverse_um = 0.0,
                         .column_um = mover.mechanical_um() - drift_um_,
                         .lamp_on = true,
                         .lamp_share = 1.0,
                         .vibration_mm_s = 0.0,
                         .column_scale_um = mover.position_um()};
  sim::ExposureSettings exposure;
  exposure.gain = course_.gain;
  exposure.exposure_us /= course_.gain;
  return camera_.take(scene, scene, exposure);
}

bridge::StageIdentity TwinColumn::identify() {
  bridge::StageIdentity identity;
  identity.column = {{0.0}, {1e6}};
  return identity;
}

bridge::StageStatus TwinColumn::exchange(std::uint16_t) {
  constexpr double kTickS = 0.02;
  optics_.mover.advance(kTickS);
  return look();
}

bridge::StageStatus TwinColumn::look() {
  bridge::StageStatus status;
  status.state = bridge::ControllerState::idle;
  status.last_result = bridge::CommandResult::done;
  status.sequence_started = sequence_;
  status.sequence_finished = optics_.mover.arrived() ? sequence_ : sequence_ - 1;
  status.column = {optics_.mover.position_um()};
  return status;
}

void TwinColumn::issue(std::uint32_t sequence, const bridge::StageCommand& command) {
  sequence_ = sequence;
  optics_.mover.go_to(command.position.value, 1e5);
}

bridge::CameraDescription TwinCamera::describe() {
  bridge::CameraDescription description{.model = "twin", .width = kWidth, .height = kHeight};
  if (has_lens_) description.lens = bridge::LensRange{.farthest = 0.5, .nearest = 12.0};
  return description;
}

void TwinCamera::apply(const bridge::CameraSettings& settings) {
  if (!settings.lens_position) return;
  optics_.mover.go_to(acquisition::distance_of(*settings.lens_position).value, 1e7);
  optics_.mover.advance(1.0);
}

bridge::Frame TwinCamera::capture(std::chrono::milliseconds) {
  const sim::Photograph photograph = optics_.photograph();
  return {.image = photograph.image,
          .sequence = photograph.number,
          .sensor_timestamp = std::chrono::nanoseconds(0),
          .exposure = std::chrono::microseconds(10000),
          .gain = 1.0};
}

}  // namespace biotomy::tests
