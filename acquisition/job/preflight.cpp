#include "acquisition/job/preflight.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "acquisition/job/capture.hpp"
#include "acquisition/job/focus_actuators.hpp"
#include "acquisition/job/job_states.hpp"
#include "acquisition/job/lens_actuator.hpp"
#include "acquisition/job/step_failure.hpp"
#include "acquisition/records/recalled_faces.hpp"
#include "acquisition/records/utc_time.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {
namespace {

constexpr std::chrono::year_month_day kProgramYear{std::chrono::year(2026) / 1 / 1};
constexpr std::chrono::minutes kClockTolerance{5};

bool inside(bridge::Micrometres position, const bridge::AxisLimits& limits) {
  return position >= limits.minimum && position <= limits.maximum;
}

std::string outside_text(const char* what, bridge::Micrometres position, const char* axis,
                         const bridge::AxisLimits& limits) {
  std::ostringstream text;
  text << what << " would be at " << position.value << " µm of the " << axis
       << ", outside its limits " << limits.minimum.value << " to " << limits.maximum.value
       << " µm: mend the configuration";
  return text.str();
}

/// The focus follows the face: where it begins and where it will have got to.
std::optional<std::string> focus_complaint(const JobSettings& settings, const char* actuator,
                                           const bridge::AxisLimits& limits) {
  const bridge::Micrometres way =
      settings.plan.face_of(settings.plan.layers) - settings.plan.face_of(1);
  if (!inside(settings.focus.start, limits)) {
    return outside_text("focus.start_um", settings.focus.start, actuator, limits);
  }
  if (!inside(settings.focus.start + way, limits)) {
    return outside_text("the focus of the last layer", settings.focus.start + way, actuator,
                        limits);
  }
  return std::nullopt;
}

void check_lens(const JobSettings& settings, const bridge::CameraDescription& camera) {
  if (settings.focus.actuator != FocusSettings::Actuator::lens) return;
  if (const auto complaint = focus_complaint(settings, "lens", lens_limits(lens_of(camera)))) {
    throw StepFailure(*complaint);
  }
}

/// A trial frame, whatever it shows: better now than with a block that is ground.
void check_frame(const bridge::Frame& frame, const bridge::CameraDescription& camera,
                 const JobPlan& plan) {
  if (frame.image.cols != camera.width || frame.image.rows != camera.height) {
    throw StepFailure("the camera says that its frames have " + std::to_string(camera.width) +
                      " × " + std::to_string(camera.height) + " pixels and gave one of " +
                      std::to_string(frame.image.cols) + " × " + std::to_string(frame.image.rows) +
                      ": look at its settings");
  }
  const int bits = frame.image.depth() == CV_16U ? 16 : 8;
  if (bits != plan.bits) {
    throw StepFailure("the camera gives " + std::to_string(bits) +
                      " bits of each colour and job.bits is " + std::to_string(plan.bits) +
                      ": make them agree");
  }
}

std::string number_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// How the camera is set, which is the same for all layers: else a change of the light could not be
/// told from a change of the tissue.
std::vector<Constant> constants_of(const bridge::CameraSettings& settings,
                                   const bridge::CameraDescription& camera) {
  return {{"camera.exposure_us", std::to_string(settings.exposure.count())},
          {"camera.gain", number_text(settings.gain)},
          {"camera.red_gain", number_text(settings.red_gain)},
          {"camera.blue_gain", number_text(settings.blue_gain)},
          {"calibration", camera.correction.empty() ? "none" : camera.correction}};
}

/// What the camera did beside what it was asked for. A sensor exposes by whole lines and amplifies
/// in steps; beyond that something else than the configuration sets it.
void check_exposure(const bridge::Frame& frame, const bridge::CameraSettings& settings) {
  constexpr double kSteps = 0.1;
  const auto complain = [](const std::string& what, double did, double asked) {
    throw StepFailure("the camera used " + what + " " + number_text(did) + " and was asked for " +
                      number_text(asked) +
                      ": switch its automatic modes off, or set what it can do");
  };
  const auto exposure = static_cast<double>(frame.exposure.count());
  const auto asked = static_cast<double>(settings.exposure.count());
  // 0 is a camera that does not say.
  if (exposure > 0.0 && std::abs(exposure - asked) > std::max(kSteps * asked, 100.0)) {
    complain("an exposure in µs of", exposure, asked);
  }
  if (frame.gain > 0.0 && std::abs(frame.gain - settings.gain) > kSteps * settings.gain) {
    complain("a gain of", frame.gain, settings.gain);
  }
}

/// Records would have wrong times for ever: a board without a battery begins in 1970.
void check_clock(std::chrono::system_clock::time_point now) {
  if (now < std::chrono::sys_days(kProgramYear)) {
    throw StepFailure("the computer's clock says " + utc_text(now) +
                      ", which cannot be: set it, or wait until the network has set it");
  }
}

void check_clock_against(const std::string& last_event_at,
                         std::chrono::system_clock::time_point now) {
  // Both are ISO 8601 in UTC: the order of the texts is the order of the times.
  if (last_event_at.empty() || utc_text(now + kClockTolerance) >= last_event_at) return;
  throw StepFailure("the computer's clock says " + utc_text(now) +
                    " and the journal has a record of " + last_event_at +
                    ": set the clock before going on");
}

}  // namespace

std::optional<bridge::StageIdentity> ask_identity(bridge::Stage& stage) {
  try {
    return stage.identify();
  } catch (const bridge::DeviceError& error) {
    const bool may_answer_yet = error.kind() == bridge::DeviceError::Kind::timeout ||
                                error.kind() == bridge::DeviceError::Kind::disconnected;
    if (!may_answer_yet) throw;
    return std::nullopt;
  }
}

std::optional<std::string> watchdog_complaint(const SafetyLimits& limits,
                                              const bridge::StageIdentity& stage) {
  if (stage.watchdog_timeout.count() != 0 || !limits.require_watchdog) return std::nullopt;
  return "the controller does not watch the daemon's heartbeat (watchdog_timeout is 0): set it, "
         "or set safety.require_watchdog to false";
}

std::optional<std::string> stage_complaint(const JobSettings& settings,
                                           const bridge::StageIdentity& stage) {
  if (auto complaint = watchdog_complaint(settings.limits, stage)) return complaint;
  for (const std::int64_t layer : {std::int64_t{1}, settings.plan.layers}) {
    const bridge::Micrometres face = settings.plan.face_of(layer);
    if (!inside(face, stage.feed)) {
      return outside_text(("layer " + std::to_string(layer)).c_str(), face, "feed", stage.feed);
    }
  }
  if (!inside({0.0}, stage.traverse)) {
    return outside_text("the parked block", {0.0}, "traverse", stage.traverse);
  }
  if (settings.focus.actuator != FocusSettings::Actuator::column) return std::nullopt;
  return focus_complaint(settings, "column", stage.column);
}

PreflightFindings inspect(const JobSettings& settings, bridge::Camera& camera,
                          const Surroundings& surroundings) {
  PreflightFindings findings;
  camera.apply(settings.camera.settings);
  findings.camera = camera.describe();
  check_lens(settings, findings.camera);
  check_clock(surroundings.wall_clock());
  findings.records =
      std::make_shared<SampleRecords>(settings.plan, settings.store, findings.camera, surroundings);
  findings.journal = findings.records->summary();
  findings.disk_left_layers = findings.records->disk_left_layers();

  check_clock_against(findings.journal.last_event_at, surroundings.wall_clock());
  findings.records->hold_constant(constants_of(settings.camera.settings, findings.camera));
  if (!findings.camera.correction.empty()) {
    findings.records->record_event({.kind = "recovery",
                                    .state = to_string(JobState::preflight),
                                    .text = "frames are corrected by " + findings.camera.correction,
                                    .at = utc_text(surroundings.wall_clock())});
  }
  // Once there are records, and whatever it shows: no frame is taken without one.
  const bridge::Frame trial = capture(camera, settings.camera.capture_time_out);
  findings.records->record_event({.kind = "recovery",
                                  .state = to_string(JobState::preflight),
                                  .text = "trial frame " + std::to_string(trial.sequence),
                                  .at = utc_text(surroundings.wall_clock())});
  check_frame(trial, findings.camera, settings.plan);
  check_exposure(trial, settings.camera.settings);

  const std::int64_t layers_to_do = settings.plan.layers - findings.journal.last_committed;
  const std::int64_t reserve = settings.limits.disk_reserve_layers;
  if (layers_to_do > 0 && findings.disk_left_layers < reserve) {
    throw DiskFull("the disk has room for " + std::to_string(findings.disk_left_layers) +
                   " more layers, less than disk_reserve_layers (" + std::to_string(reserve) +
                   "): make room");
  }
  if (settings.limits.disk_for_whole_job && findings.disk_left_layers < layers_to_do) {
    throw DiskFull("the disk has room for " + std::to_string(findings.disk_left_layers) +
                   " more layers and the job needs " + std::to_string(layers_to_do) +
                   ": make room, or set safety.disk_for_whole_job to false");
  }
  findings.recalled = recall_faces(findings.records->sample(), findings.journal.last_committed,
                                   surroundings.read_layer);
  return findings;
}

}  // namespace biotomy::acquisition
