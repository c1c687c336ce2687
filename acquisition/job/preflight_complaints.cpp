#include "acquisition/job/preflight_complaints.hpp"

#include <algorithm>
#include <sstream>

#include "acquisition/number_text.hpp"
#include "acquisition/records/utc_time.hpp"
#include "acquisition/rig/focus_actuators.hpp"
#include "acquisition/rig/lens_actuator.hpp"
#include "acquisition/rig/stage_identity.hpp"
#include "acquisition/rig/step_failure.hpp"
#include "firmware_bridge/camera/told_settings.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::chrono::year_month_day kProgramYear{std::chrono::year(2026) / 1 / 1};
constexpr std::chrono::minutes kClockTolerance{5};

bool inside(bridge::Micrometres position, const bridge::AxisLimits& limits) {
  return position >= limits.minimum && position <= limits.maximum;
}

std::string outside_text(const std::string& what, bridge::Micrometres position, const char* axis,
                         const bridge::AxisLimits& limits) {
  std::ostringstream text;
  text << what << " would be at " << position.value << " µm of the " << axis
       << ", outside its limits " << limits.minimum.value << " to " << limits.maximum.value
       << " µm: mend the configuration";
  return text.str();
}

/// The focus follows the face: where it begins and where it will have got to.
void add_focus_complaints(const JobSettings& settings, const char* actuator,
                          const bridge::AxisLimits& limits, Complaints& complaints) {
  const bridge::Micrometres start = settings.focus.start;
  const bridge::Micrometres end =
      start + (settings.plan.face_of(settings.plan.layers) - settings.plan.face_of(1));
  if (!inside(start, limits)) {
    complaints.push_back(outside_text("focus.start_um", start, actuator, limits));
  }
  if (!inside(end, limits)) {
    complaints.push_back(outside_text("the focus of the last layer", end, actuator, limits));
  }
}

/// What the camera did beside what it was asked for: something else than the configuration sets it.
void add_exposure_complaints(const bridge::Frame& frame, const bridge::CameraSettings& settings,
                             Complaints& complaints) {
  bridge::ToldSettings told;
  // 0 is a camera that does not say.
  if (frame.exposure.count() > 0) told.exposure = frame.exposure;
  if (frame.gain > 0.0) told.gain = frame.gain;
  if (const auto difference = bridge::difference(settings, told)) {
    complaints.push_back("the camera took a frame with " + *difference +
                         ": switch its automatic modes off, or set what it can do");
  }
}

}  // namespace

Complaints stage_complaints(const JobSettings& settings, const bridge::StageIdentity& stage) {
  Complaints complaints;
  if (const auto complaint = watchdog_complaint(settings.limits, stage)) {
    complaints.push_back(*complaint);
  }
  // By a larger one a pass that went a layer too deep would pass for the right one.
  if (settings.limits.position_tolerance.value > settings.plan.layer_thickness.value / 2.0) {
    std::ostringstream text;
    text << "safety.position_tolerance_um is " << settings.limits.position_tolerance.value
         << " and must be at most half of job.layer_thickness_um, which is "
         << settings.plan.layer_thickness.value;
    complaints.push_back(text.str());
  }
  for (const std::int64_t layer : {std::int64_t{1}, settings.plan.layers}) {
    const bridge::Micrometres face = settings.plan.face_of(layer);
    if (!inside(face, stage.feed)) {
      complaints.push_back(
          outside_text("layer " + std::to_string(layer), face, "feed", stage.feed));
    }
    if (settings.plan.layers == 1) break;
  }
  if (!inside({0.0}, stage.traverse)) {
    complaints.push_back(outside_text("the parked block", {0.0}, "traverse", stage.traverse));
  }
  if (settings.focus.actuator == FocusSettings::Actuator::column) {
    add_focus_complaints(settings, "column", stage.column, complaints);
  }
  return complaints;
}

Complaints camera_complaints(const JobSettings& settings, const bridge::CameraDescription& camera) {
  Complaints complaints;
  if (settings.focus.actuator != FocusSettings::Actuator::lens) return complaints;
  try {
    add_focus_complaints(settings, "lens", lens_limits(lens_of(camera)), complaints);
  } catch (const StepFailure& no_lens) {
    complaints.emplace_back(no_lens.what());
  }
  return complaints;
}

Complaints frame_complaints(const JobSettings& settings, const bridge::CameraDescription& camera,
                            const bridge::Frame& frame) {
  Complaints complaints;
  if (frame.image.cols != camera.width || frame.image.rows != camera.height) {
    complaints.push_back("the camera says that its frames have " + std::to_string(camera.width) +
                         " × " + std::to_string(camera.height) + " pixels and gave one of " +
                         std::to_string(frame.image.cols) + " × " +
                         std::to_string(frame.image.rows) + ": look at its settings");
  }
  const int bits = frame.image.depth() == CV_16U ? 16 : 8;
  if (bits != settings.plan.bits) {
    complaints.push_back("the camera gives " + std::to_string(bits) +
                         " bits of each colour and job.bits is " +
                         std::to_string(settings.plan.bits) + ": make them agree");
  }
  add_exposure_complaints(frame, settings.camera.settings, complaints);
  return complaints;
}

Complaints clock_complaints(std::chrono::system_clock::time_point now,
                            const std::string& last_event_at) {
  Complaints complaints;
  // A board without a battery begins in 1970.
  if (now < std::chrono::sys_days(kProgramYear)) {
    complaints.push_back("the computer's clock says " + utc_text(now) +
                         ", which cannot be: set it, or wait until the network has set it");
  }
  // Both are ISO 8601 in UTC: the order of the texts is the order of the times.
  if (!last_event_at.empty() && utc_text(now + kClockTolerance) < last_event_at) {
    complaints.push_back("the computer's clock says " + utc_text(now) +
                         " and the journal's last record is of " + last_event_at +
                         ", which lies ahead: if the clock is wrong, set it; if it is right, the "
                         "record is wrong: acknowledge the alarm that says so, and resume");
  }
  return complaints;
}

Complaints disk_complaints(const JobSettings& settings, std::int64_t disk_left_layers,
                           std::int64_t last_committed) {
  Complaints complaints;
  const std::int64_t layers_to_do = settings.plan.layers - last_committed;
  const std::int64_t reserve = settings.limits.disk_reserve_layers;
  const std::string room =
      "the disk has room for " + std::to_string(disk_left_layers) + " more layers";
  if (layers_to_do > 0 && disk_left_layers < reserve) {
    complaints.push_back(room + ", less than disk_reserve_layers (" + std::to_string(reserve) +
                         "): make room");
  }
  if (settings.limits.disk_for_whole_job && disk_left_layers < layers_to_do) {
    complaints.push_back(room + " and the job needs " + std::to_string(layers_to_do) +
                         ": make room, or set safety.disk_for_whole_job to false");
  }
  return complaints;
}

std::vector<Constant> constants_of(const bridge::CameraSettings& settings,
                                   const bridge::CameraDescription& camera) {
  return {{"camera.exposure_us", std::to_string(settings.exposure.count())},
          {"camera.gain", number_text(settings.gain)},
          {"camera.red_gain", number_text(settings.red_gain)},
          {"camera.blue_gain", number_text(settings.blue_gain)},
          {"calibration", camera.correction.empty() ? "none" : camera.correction}};
}

}  // namespace biotomy::acquisition
