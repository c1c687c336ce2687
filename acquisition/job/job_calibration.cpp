// How a job at rest records calibrations.
#include "acquisition/calibration/calibration_record.hpp"
#include "acquisition/calibration/focus_calibration.hpp"
#include "acquisition/calibration/frame_calibration.hpp"
#include "acquisition/job/job.hpp"
#include "acquisition/job/step_alarm.hpp"
#include "acquisition/log.hpp"
#include "acquisition/records/utc_time.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {
namespace {

OperatorReply refused(const std::string& sentence) {
  return {false, sentence};
}

}  // namespace

std::optional<std::string> Job::why_no_calibration() const {
  if (calibration_) return "a calibration is under way already";
  if (state_ == JobState::faulted) {
    return "the rig is stopped by an alarm (" + alarm_->cause + "): acknowledge it first";
  }
  if (state_ != JobState::idle && state_ != JobState::done && state_ != JobState::aborted) {
    return std::string("the job is ") + to_string(state_) +
           ": calibrate before it begins or after its end";
  }
  if (const auto cause = supervision_.standing_cause()) {
    return "something is wrong with the rig: " + cause->sentence;
  }
  return std::nullopt;
}

/// All layers of a sample are corrected by the same fields. What else is calibrated becomes part of
/// the configuration, which says so when it is changed.
std::optional<std::string> Job::why_no_field() const {
  if (auto why = why_no_calibration()) return why;
  if (committed_ == 0 || committed_ >= settings_.plan.layers) return std::nullopt;
  return "the sample " + settings_.plan.sample.string() + " has " + std::to_string(committed_) +
         " of its " + std::to_string(settings_.plan.layers) +
         " layers, and the others must be corrected as these are: finish it first, or name another "
         "sample in job.sample and restart the daemon";
}

OperatorReply Job::calibration_begun(const char* kind) {
  calibration_status_ = {kind, CalibrationStatus::Progress::running, calibration_->progress()};
  return {true, "the calibration has begun"};
}

OperatorReply Job::calibrate(CalibrationKind kind, TimePoint now) {
  if (const auto why = why_no_calibration()) return refused(*why);
  bridge::Camera& camera = parts_.plain_camera != nullptr ? *parts_.plain_camera : parts_.camera;
  const auto utc_now = [clock = surroundings_.wall_clock] { return utc_text(clock()); };
  try {
    calibration_ = std::make_unique<FrameCalibration>(
        kind, settings_.calibration, settings_.camera, settings_.plan.lamp_warm_up,
        FrameCalibrationParts{camera, parts_.lines, parts_.worker}, utc_now, now);
  } catch (const bridge::DeviceError& error) {
    return refused(error.what());
  }
  return calibration_begun(to_string(kind));
}

OperatorReply Job::calibrate_focus(TimePoint now) {
  if (const auto why = why_no_calibration()) return refused(*why);
  supervision_.forget_positions();
  if (const auto cause = supervision_.cause()) {
    // What only an acknowledgement cures needs a latch to acknowledge.
    fault(*cause, now);
    return refused("the rig is stopped by an alarm (" + cause->sentence +
                   "): acknowledge it first");
  }
  if (!fresh_) return refused("the controller did not answer just now: try again");
  if (const auto complaint = focus_calibration_complaint(*fresh_, settings_.limits))
    return refused(*complaint);
  const auto utc_now = [clock = surroundings_.wall_clock] { return utc_text(clock()); };
  calibration_ = std::make_unique<FocusCalibration>(
      settings_,
      FocusCalibrationParts{parts_.stage, commands_, parts_.lines, parts_.camera, parts_.worker},
      utc_now, now);
  return calibration_begun("focus");
}

void Job::poll_calibration(TimePoint now) {
  using enum CalibrationStatus::Progress;
  if (calibration_given_up_) {
    confirm_calibration_stopped(now);
    return;
  }
  if (const auto cause = supervision_.standing_cause()) {
    give_up_calibration(cause->sentence, now);
    return;
  }
  try {
    if (const auto found = calibration_->poll(fresh_, now)) {
      end_calibration(done, *found);
    } else {
      calibration_status_.sentence = calibration_->progress();
    }
  } catch (const CalibrationError& error) {
    end_calibration(failed, error.what());
  } catch (const std::exception& error) {
    // Whoever moves axes and cannot go on leaves a rig that a person must look at.
    if (calibration_->moves_axes()) {
      fault({alarm_kind_of(error, JobState::idle), error.what()}, now);
    } else {
      end_calibration(failed, error.what());
    }
  }
}

void Job::give_up_calibration(const std::string& why, TimePoint now) {
  if (calibration_->moves_axes() && !commands_.stop_now(now)) {
    fault(
        {AlarmKind::controller, "the stage did not take the stop of its calibration (" + why + ")"},
        now);
    return;
  }
  const std::string sentence = "it was given up: " + why;
  if (calibration_->moves_axes()) {
    calibration_given_up_ = sentence;
    calibration_status_.sentence = "waits for the controller to take the stop";
  } else {
    end_calibration(CalibrationStatus::Progress::failed, sentence);
  }
}

/// A stop is believed when the controller has carried it out.
void Job::confirm_calibration_stopped(TimePoint now) {
  if (!fresh_) return;
  try {
    if (commands_.poll(*fresh_, now)) {
      end_calibration(CalibrationStatus::Progress::failed, std::string(*calibration_given_up_));
    }
  } catch (const StepFailure& failure) {
    fault({alarm_kind_of(failure, JobState::idle), failure.what()}, now);
  }
}

void Job::end_calibration(CalibrationStatus::Progress progress, const std::string& sentence) {
  calibration_.reset();
  calibration_given_up_.reset();
  lamp_and_tower(false);
  calibration_status_.progress = progress;
  calibration_status_.sentence = sentence;
  const std::string text = "calibration, " + calibration_status_.kind + ": " + sentence;
  log_info("calibration", text);
  note("operator", text);
}

}  // namespace biotomy::acquisition
