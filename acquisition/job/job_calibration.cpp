// How a job at rest records calibrations.
#include "acquisition/calibration/calibration_run.hpp"
#include "acquisition/job/job.hpp"
#include "acquisition/log.hpp"
#include "acquisition/records/utc_time.hpp"
#include "firmware_bridge/device_error.hpp"

namespace biotomy::acquisition {

OperatorReply Job::calibrate(CalibrationKind kind, TimePoint now) {
  const auto refused = [](std::string sentence) {
    return OperatorReply{false, std::move(sentence)};
  };
  if (calibration_) return refused("a calibration is under way already");
  if (state_ == JobState::faulted) {
    return refused("the rig is stopped by an alarm (" + alarm_->cause + "): acknowledge it first");
  }
  if (state_ != JobState::idle && state_ != JobState::done && state_ != JobState::aborted) {
    return refused(std::string("the job is ") + to_string(state_) +
                   ": calibrate before it begins or after its end");
  }
  if (const auto cause = supervision_.standing_cause()) {
    return refused("something is wrong with the rig: " + *cause);
  }
  bridge::Camera& camera = parts_.plain_camera != nullptr ? *parts_.plain_camera : parts_.camera;
  const auto utc_now = [clock = surroundings_.wall_clock] { return utc_text(clock()); };
  try {
    calibration_ = std::make_unique<CalibrationRun>(
        kind, settings_.calibration, settings_.camera, settings_.plan.lamp_warm_up,
        CalibrationParts{camera, parts_.lines, parts_.worker}, utc_now, now);
  } catch (const bridge::DeviceError& error) {
    return refused(error.what());
  }
  calibration_status_ = {to_string(kind), CalibrationStatus::Progress::running, "takes frames"};
  return {true, "the calibration has begun"};
}

void Job::poll_calibration(TimePoint now) {
  using enum CalibrationStatus::Progress;
  if (const auto cause = supervision_.standing_cause()) {
    end_calibration(failed, "it was given up: " + *cause);
    return;
  }
  try {
    if (const auto found = calibration_->poll(now)) {
      end_calibration(done, *found);
    } else {
      calibration_status_.sentence = std::to_string(calibration_->taken()) + " of " +
                                     std::to_string(settings_.calibration.frames) +
                                     " frames are taken";
    }
  } catch (const std::exception& error) {
    end_calibration(failed, error.what());
  }
}

void Job::end_calibration(CalibrationStatus::Progress progress, const std::string& sentence) {
  calibration_.reset();
  lamp_and_tower(false);
  calibration_status_.progress = progress;
  calibration_status_.sentence = sentence;
  const std::string text = "calibration, " + calibration_status_.kind + ": " + sentence;
  log_info("calibration", text);
  note("operator", text);
}

}  // namespace biotomy::acquisition
