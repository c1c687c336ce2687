#include "acquisition/calibration/focus_calibration.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "acquisition/calibration/calibration_record.hpp"
#include "acquisition/calibration/focus_record.hpp"
#include "acquisition/focus/depth_of_field.hpp"
#include "acquisition/rig/focus_actuators.hpp"
#include "acquisition/rig/stage_checks.hpp"
#include "acquisition/rig/stage_identity.hpp"

namespace biotomy::acquisition {
namespace {

std::optional<std::string> wheel_complaint(const bridge::StageStatus& status,
                                           const SafetyLimits& limits) {
  if (!wheel_turns(status, limits)) return std::nullopt;
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "the wheel turns at %.0f rpm and must stand still",
                status.spindle_rpm);
  return text.data();
}

}  // namespace

std::optional<std::string> focus_calibration_complaint(const bridge::StageStatus& status,
                                                       const SafetyLimits& limits) {
  if (status.state != bridge::ControllerState::idle) {
    return std::string("the controller is ") + bridge::to_string(status.state) +
           " and must be idle: try again in a moment";
  }
  return wheel_complaint(status, limits);
}

FocusCalibration::FocusCalibration(const JobSettings& settings, const FocusCalibrationParts& parts,
                                   std::function<std::string()> utc_now, TimePoint now)
    : settings_(settings),
      parts_(parts),
      utc_now_(std::move(utc_now)),
      homing_(parts.commands),
      parking_(parts.commands, settings.limits),
      begun_(now),
      camera_(run_on(parts.worker, [camera = &parts.camera, with = settings.camera.settings] {
        camera->apply(with);
        return camera->describe();
      })) {}

std::optional<std::string> FocusCalibration::poll(const std::optional<bridge::StageStatus>& status,
                                                  TimePoint now) {
  if (const auto longest = limit(); longest && now - begun_ > *longest) {
    throw StepFailure("a step of the calibration took longer than " +
                      std::to_string(longest->count()) + " ms: it " + progress());
  }
  if (phase_ == Phase::recording) {
    return is_ready(record_) ? std::optional(record_.get()) : std::nullopt;
  }
  if (!status) return std::nullopt;  // without a view of the rig nothing moves on
  if (const auto complaint = wheel_complaint(*status, settings_.limits))
    throw StepFailure(*complaint);
  const bool past_homing = phase_ != Phase::asking && phase_ != Phase::homing;
  if (past_homing && !status->interlocks.homed) {
    throw StepFailure("the controller lost its reference: its axes are not homed any more");
  }
  poll_step(*status, now);
  return std::nullopt;
}

void FocusCalibration::go(Phase phase, TimePoint now) {
  phase_ = phase;
  begun_ = now;
}

std::optional<std::chrono::milliseconds> FocusCalibration::limit() const {
  switch (phase_) {
    case Phase::asking:
      return settings_.limits.preflight_limit;
    case Phase::homing:
      return settings_.limits.home_limit;
    case Phase::searching:
    case Phase::going_back:
      return settings_.limits.focus_limit;
    case Phase::recording:
      return settings_.limits.store_limit;
    case Phase::parking:
    case Phase::lighting:
      break;  // watches its own limit, or ends by itself
  }
  return std::nullopt;
}

void FocusCalibration::poll_step(const bridge::StageStatus& status, TimePoint now) {
  switch (phase_) {
    case Phase::asking:
      return poll_asking(status, now);
    case Phase::homing:
      if (!homing_.poll(status, now)) return;
      parking_.begin(Parking::From::rest, now);
      return go(Phase::parking, now);
    case Phase::parking:
      if (!parking_.poll(status, now)) return;
      parts_.lines.set(bridge::OutputRole::lamp, true);
      return go(Phase::lighting, now);
    case Phase::lighting:
      if (now - begun_ >= settings_.plan.lamp_warm_up) begin_search(status, now);
      return;
    case Phase::searching:
      return poll_search(status, now);
    case Phase::going_back:
      if (actuator_->settled(status, now)) throw CalibrationError(why_not_found());
      return;
    case Phase::recording:
      return;
  }
}

/// Everything that can be known to hinder it is known before anything moves.
void FocusCalibration::poll_asking(const bridge::StageStatus& status, TimePoint now) {
  if (!identity_) identity_ = ask_identity(parts_.stage);
  if (!identity_ || !is_ready(camera_)) return;
  if (const auto complaint = watchdog_complaint(settings_.limits, *identity_)) {
    throw CalibrationError(*complaint);
  }
  actuator_ = make_focus_actuator(settings_, identity_->column, camera_.get(),
                                  {parts_.commands, parts_.camera, parts_.worker});
  was_homed_ = status.interlocks.homed;
  homing_.begin();
  go(Phase::homing, now);
}

void FocusCalibration::begin_search(const bridge::StageStatus& status, TimePoint now) {
  column_stood_at_ = status.column;
  // A column off its home is where somebody, or a job, has brought it to see the face. At home, or
  // just homed, it stands nowhere in particular; and where a lens stands is not known.
  const bool was_brought_there =
      settings_.focus.actuator == FocusSettings::Actuator::column && was_homed_ &&
      status.column > identity_->column.minimum + settings_.limits.position_tolerance;
  const SearchPlan anywhere{.predicted = was_brought_there ? status.column : settings_.focus.start,
                            .step = settings_.focus.step,
                            .largest_change = {}};
  search_.emplace(settings_, anywhere, SearchParts{*actuator_, parts_.camera, parts_.worker}, now);
  go(Phase::searching, now);
}

void FocusCalibration::poll_search(const bridge::StageStatus& status, TimePoint now) {
  if (!search_->poll(status, now)) return;
  if (search_->found()) {
    begin_recording(*search_->found());
    go(Phase::recording, now);
    return;
  }
  if (settings_.focus.actuator == FocusSettings::Actuator::lens) {
    throw CalibrationError(why_not_found());
  }
  const bridge::AxisLimits limits = actuator_->limits();
  actuator_->move_to(std::clamp(column_stood_at_, limits.minimum, limits.maximum), now);
  go(Phase::going_back, now);
}

void FocusCalibration::begin_recording(const Autofocus::Found& found) {
  FocusRecord record{.actuator = actuator_->name(),
                     .position = actuator_->describe(found.position),
                     .plane = found.position,
                     .step = found.step,
                     .depth_of_field = depth_of_field_by_curve(found.step, settings_.focus.points),
                     .lean = search_->lean(),
                     .points = search_->points(),
                     .settings = settings_.camera.settings,
                     .found_at = utc_now_()};
  record_ =
      run_on(parts_.worker, [folder = settings_.calibration.folder, record = std::move(record)] {
        write_focus_record(folder, record);
        return sentence_of(record);
      });
}

std::string FocusCalibration::why_not_found() const {
  return "no focus was found around " + actuator_->describe(search_->predicted()) + " of the " +
         actuator_->name() + ": " + search_->why_not() +
         ": see that the face lies under the camera, is lit and shows detail, then set "
         "focus.start_um nearer to the focus, or focus.reach_um wider";
}

std::string FocusCalibration::progress() const {
  switch (phase_) {
    case Phase::asking:
      return "asks the controller and the camera";
    case Phase::homing:
      return "waits for the axes to find their reference";
    case Phase::parking:
      return parking_.waiting_for();
    case Phase::lighting:
      return "waits for the lamp";
    case Phase::searching:
      return "searches the focus: " + std::to_string(search_->points().size()) + " frames";
    case Phase::going_back:
      return "finds no focus, and takes the column back to where it stood";
    case Phase::recording:
      return "writes down what it found";
  }
  return "";
}

}  // namespace biotomy::acquisition
